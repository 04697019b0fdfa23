"""A sphere of rubble thrown apart that falls back under its own gravity (engine/physics.md, sections 1, 4 and 7)."""

from dataclasses import dataclass
from math import inf

import numpy as np

from engine.arrays import Vectors
from engine.constants import G_NEWTON
from engine.scene.bodies import Sphere
from engine.scene.scene import Physics, Scene
from engine.simulation.initial_conditions import initial_state
from engine.verification.check import Check
from engine.verification.harness import Harness

DENSITY = 2700.0
RADIUS = 50e3


@dataclass(frozen=True)
class Fallback:
    """Rubble with v = H r below escape: dust that turns at a known radius, is back at a known time, and rests dense.

    As in the collapse of a sphere without pressure, r/R = s cos^2 b at (b + sin(2b)/2) (s^3 R^3/(2 G M))^(1/2) before
    and after it turns at s R. Rubble that is back falls together at its speed of departure, which friction takes away.

    Its surface bounces and comes to rest loose in layers that cells do not resolve, so the sum of m/rho errs by
    about first order in the particle spacing. The energy is conserved if the ledger has what the transfer dissipates;
    without it 94 % of the kinetic energy vanishes.

    Attributes:
        particles: numbers of particles, from few to many.
        stretch: radius where it turns, over R [-].
        rest: time to settle, over that of the flight [-].
        spin: angular velocity at the start [rad/s]; a fiftieth of the one at which matter leaves the equator.
    """

    name = "fallback"
    particles: tuple[int, int] = (500, 1000)
    stretch: float = 1.5
    rest: float = 2.0
    spin: float = 2e-5

    @property
    def rate(self) -> float:
        """H [1/s], v^2/2 = G M (1/R - 1/(s R))."""
        return float(np.sqrt(8.0 / 3.0 * np.pi * G_NEWTON * DENSITY * (1.0 - 1.0 / self.stretch)))

    @property
    def half_flight(self) -> float:
        """Time from the start until it turns [s]."""
        b = np.arccos(np.sqrt(1.0 / self.stretch))
        return float((b + 0.5 * np.sin(2.0 * b)) * np.sqrt(self.stretch**3 / (8.0 / 3.0 * np.pi * G_NEWTON * DENSITY)))

    def scene(self, particles: int) -> Scene:
        """Broken basalt without pressure at the start."""
        body = Sphere(radius=RADIUS, particles=particles, damage=1.0, hydrostatic=False, spin=(0.0, 0.0, self.spin))
        end = 2.0 * self.half_flight * (1.0 + self.rest)
        return Scene(bodies=(body,), end_time=end, physics=Physics(fracture=None, sound_speed=0.25))

    def checks(self, harness: Harness) -> list[Check]:
        """Compare where it turns, and volume, density, angular momentum and energy at rest, with the exact ones."""
        coarse, fine = (self.measure(harness, count) for count in self.particles)
        ratio = (self.particles[1] / self.particles[0]) ** (1.0 / 3.0)
        limit = (ratio * fine["volume"] - coarse["volume"]) / (ratio - 1.0)
        return [
            Check.relative("radius where it turns, over R", "-", fine["turned"], self.stretch, 0.05),
            Check.relative("radius at rest, over R", "-", fine["radius"], 1.0, 0.05),
            Check.relative("sum of m/rho at rest, over that at the start", "-", fine["volume"], 1.0, inf),
            Check.relative("the same, extrapolated with order 1", "-", limit, 1.0, 0.02),
            Check.relative("density at rest, median", "kg/m3", fine["density"], DENSITY, 0.02),
            Check.absolute("change of the angular momentum, over it", "-", fine["spin"], 0.0, 1e-4),
            Check.absolute("total energy lost, over the kinetic energy at the start", "-", fine["lost"], 0.0, 0.01),
        ]

    def measure(self, harness: Harness, particles: int) -> dict[str, float]:
        """Return what a run of this many particles shows, relative to its start."""
        scene = self.scene(particles)
        start = initial_state(scene)
        flow = {"v": start["v"] + self.rate * start["x"], "C": start["C"] + self.rate * np.eye(3)}
        simulation = harness.start(scene, **flow)
        before = simulation.totals()
        turned = harness.run_until(simulation, self.half_flight)
        end = harness.run_until(simulation, scene.end_time)
        after = simulation.totals()
        return {
            "turned": _growth(start["x"], turned.x),
            "radius": _growth(start["x"], end.x),
            "volume": float(end.J.mean()),
            "density": DENSITY / float(np.median(end.J)),
            "spin": float(after.angular_momentum[2] / before.angular_momentum[2]) - 1.0,
            "lost": (before.total_energy - after.total_energy) / before.kinetic_energy,
        }


def _growth(before: Vectors, after: Vectors) -> float:
    """Ratio of the roots of the mean squared distances from the centre [-]."""
    return float(np.sqrt(np.sum(after**2) / np.sum(before**2)))
