"""Collapse of a sphere without pressure (engine/physics.md, section 7)."""

from dataclasses import dataclass
from math import inf

import numpy as np

from engine.constants import G_NEWTON
from engine.scene.bodies import Sphere
from engine.scene.scene import Gravity, Numerics, Physics, Scene
from engine.verification.check import Check
from engine.verification.harness import Harness, fitted_order
from engine.verification.problems.materials import elastic

SOFT = 1.0
"""Bulk modulus [Pa]: a millionth of the central pressure that would balance gravity."""


@dataclass(frozen=True)
class Fall:
    """A homogeneous sphere falls from rest onto its centre: r/R = cos^2 b at (b + sin(2b)/2) sqrt(3/(8 pi G rho)).

    Attributes:
        particles: number of particles.
        until: time at which it is measured, over the collapse time [-].
    """

    particles: int
    until: float = 0.8

    @property
    def scene(self) -> Scene:
        """The sphere in cells of one particle, under its own gravity only."""
        body = Sphere(
            radius=50e3, particles=self.particles, material=elastic(2700.0, SOFT, SOFT), damage=1.0, hydrostatic=False
        )
        gravity = Gravity(softening=0.3, interval=1.0, opening=0.3)
        return Scene(
            bodies=(body,),
            end_time=self.until * self.collapse_time,
            physics=Physics(shear=False, strength=False, fracture=None, gravity=gravity),
            numerics=Numerics(particles_per_cell=1.0),
        )

    @property
    def collapse_time(self) -> float:
        """sqrt(3 pi/(32 G rho)) [s]."""
        return float(np.sqrt(3.0 * np.pi / (32.0 * G_NEWTON * 2700.0)))

    def measure(self, harness: Harness) -> float:
        """Return the collapse time that the size at `until` implies [s]."""
        simulation = harness.start(self.scene)
        before = simulation.particles.read("x")["x"]
        end = harness.run_until(simulation, self.scene.end_time)
        ratio = float(np.sqrt(np.mean(end.x**2) / np.mean(before**2)))
        angle = np.arccos(np.sqrt(ratio))
        return float(end.time * 0.5 * np.pi / (angle + 0.5 * np.sin(2.0 * angle)))


@dataclass(frozen=True)
class Collapse:
    """Collapse time, and how fast its error falls with dx.

    A kick of gravity passes through the grid, which blurs it at the surface: the fall is late by (dx/R)^2.

    Attributes:
        particles: resolutions.
    """

    name = "collapse"
    particles: tuple[int, int] = (1000, 4000)

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the collapse time extrapolated to dx = 0 and the order of its error; show that of the finest run."""
        falls = [Fall(particles) for particles in self.particles]
        coarse, fine = (fall.measure(harness) for fall in falls)
        exact, sizes = falls[0].collapse_time, [fall.scene.dx for fall in falls]
        order = fitted_order(sizes, [abs(coarse - exact), abs(fine - exact)])
        limit = fine - (coarse - fine) / ((sizes[0] / sizes[1]) ** 2 - 1.0)
        return [
            Check.relative(f"collapse time, {self.particles[-1]} particles", "s", fine, exact, inf),
            Check.relative("collapse time, extrapolated with order 2", "s", limit, exact, 0.005),
            Check("order of the collapse time in dx", "-", order, 2.0, max(0.0, 2.0 - order), 0.3),
        ]
