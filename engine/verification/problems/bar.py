"""Rock pulled apart at a constant rate (engine/physics.md, sections 2-5)."""

from dataclasses import dataclass
from math import inf

import numpy as np

from engine.laws.flaws import Flaws, draw_flaws
from engine.laws.fracture import Fracture
from engine.scene.bodies import Sphere
from engine.scene.material import FractureRules, Material
from engine.verification.check import Check
from engine.verification.harness import Array, Harness
from engine.verification.material_point import MaterialPoint

CONTINUUM_PEAK = 9.07e6
"""Peak stress [Pa] at 1 1/s of the continuum law, ~ rate^(1/4); a guide: it has infinitely many flaws."""


@dataclass(frozen=True)
class Pull:
    """A laterally confined bar of particles that all stretch at one rate, each with its own flaws.

    Attributes:
        rate: d ln(length)/dt [1/s].
        particles: number of particles.
        radius: of the sphere of the same volume [m]; it sets the weakest flaw.
        steps: number of time steps.
    """

    rate: float
    particles: int = 200
    radius: float = 1.0
    steps: int = 2000

    @property
    def body(self) -> Sphere:
        """Sphere of the bar's volume and material."""
        return Sphere(radius=self.radius, particles=self.particles)

    @property
    def flaws(self) -> Flaws:
        """Flaws, the same for both integrations."""
        return draw_flaws(self.body, FractureRules(), np.random.default_rng(1))

    @property
    def strain(self) -> float:
        """Strain at the end [-]: beyond the peak, also of fast bars, which outrun their cracks."""
        return max(2e-3, 3e-4 * self.rate)

    @property
    def dt(self) -> float:
        """Time step [s]."""
        return self.strain / self.rate / self.steps

    def engine(self, harness: Harness) -> Array:
        """Return the mean axial stress [Pa] after every step by the engine's laws, shape [steps]."""
        growth = Fracture([self.body], FractureRules(), self.flaws)
        points = MaterialPoint(self.body.count, self.body.material, strength=True, fracture=growth)
        with harness.timed():
            return np.array([self._stretch(points) for _ in range(self.steps)])

    def _stretch(self, points: MaterialPoint) -> float:
        """Mean axial stress [Pa] after one more step."""
        points.step(np.diag([self.rate, 0.0, 0.0]), self.dt)
        return float(np.mean(points.stress[:, 0, 0]))

    def reference(self) -> Array:
        """Return the same of cold rock by an integration in NumPy.

        Stretched along one axis only, its logarithmic strain is the sum of all increments.
        """
        m = self.body.material
        own = [np.sort(part) for part in np.split(self.flaws.strain, self.flaws.first[1:-1])]
        growth = 0.4 * m.longitudinal_speed / (3.0 * self.body.spacing)
        root, mean = np.zeros(self.particles), []
        for step in range(1, self.steps + 1):
            e = step * np.log1p(self.rate * self.dt)
            axial = _stress(e, root**3, m)
            cracks = np.array(
                [np.searchsorted(part, s) for part, s in zip(own, axial / m.longitudinal_modulus, strict=True)]
            )
            cap = np.cbrt(cracks / [len(part) for part in own])
            root = np.maximum(root, np.minimum(root + cracks * growth * self.dt, cap))
            mean.append(axial.mean())
        return np.array(mean)


def _stress(e: float, D: Array, m: Material) -> Array:
    """Axial Cauchy stress [Pa] at the log strain e: (1 - D) P, and shear up to the strength."""
    mu = np.expm1(-e)
    pressure = (1.0 - D) * m.eos.pressure(m.rho0, mu, 0.0)
    root_J2 = 2.0 * m.shear_modulus * np.exp(-e) * e / np.sqrt(3.0)
    shear = np.minimum(root_J2, (1.0 - D) * m.known("cohesion"))
    return np.asarray(2.0 / np.sqrt(3.0) * shear - pressure)


@dataclass(frozen=True)
class Bar:
    """Peak stress over four decades of strain rate, by the engine and by an independent integration of the same flaws.

    Attributes:
        rates: strain rates [1/s].
    """

    name = "bar"
    rates: tuple[float, ...] = (0.01, 0.1, 1.0, 10.0, 100.0)

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the peak stress with the independent integration; show it beside the continuum law."""
        checks = []
        for rate in self.rates:
            bar = Pull(rate)
            peak, expected = float(bar.engine(harness).max()), float(bar.reference().max())
            guide = CONTINUUM_PEAK * rate**0.25
            checks += [
                Check.relative(f"peak stress at {rate:g} /s", "Pa", peak, expected, 0.01),
                Check.relative(f"beside the continuum law at {rate:g} /s", "Pa", peak, guide, inf),
            ]
        return checks
