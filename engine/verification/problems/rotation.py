"""Free rotation of an elastic sphere (engine/physics.md, section 1)."""

from dataclasses import dataclass

import numpy as np

from engine.scene.bodies import Sphere
from engine.scene.scene import Physics, Scene
from engine.simulation.conservation import Totals
from engine.verification.check import Check
from engine.verification.harness import Harness


@dataclass(frozen=True)
class Rotation:
    """A sphere turns once about a skew axis: angular momentum and energy are constant.

    It also stretches, as it was given no centrifugal stress: the work of stress is then the energy of strain.

    Attributes:
        particles: number of particles.
        rate: angular velocity [rad/s]; the surface moves at 100 m/s.
    """

    name = "rotation"
    particles: int = 1000
    rate: float = 2e-3

    @property
    def scene(self) -> Scene:
        """One turn of an intact sphere of R = 50 km without gravity."""
        spin = (self.rate / 3.0, 2.0 * self.rate / 3.0, 2.0 * self.rate / 3.0)
        body = Sphere(radius=50e3, particles=self.particles, spin=spin, hydrostatic=False)
        physics = Physics(strength=False, fracture=None, gravity=None)
        return Scene(bodies=(body,), end_time=2.0 * np.pi / self.rate, physics=physics)

    def checks(self, harness: Harness) -> list[Check]:
        """Compare angular momentum and energies after one turn with those before."""
        scene = self.scene
        simulation = harness.start(scene)
        start = simulation.totals()
        harness.run_until(simulation, scene.end_time)
        end = simulation.totals()
        before = float(np.linalg.norm(start.angular_momentum))
        change = float(np.linalg.norm(end.angular_momentum - start.angular_momentum))
        work = end.internal_energy - end.transfer_heat
        return [
            Check("angular momentum", "kg m2/s", before + change, before, change / before, 1e-12),
            Check.relative("kinetic and elastic energy", "J", _motion(end), _motion(start), 1e-3),
            Check.relative("total energy", "J", end.total_energy, start.total_energy, 1e-3),
            Check.relative("work of stress against elastic energy", "J", work, end.elastic_energy, 1e-2),
        ]


def _motion(totals: Totals) -> float:
    """Kinetic energy, affine part included, and elastic energy [J]."""
    return totals.kinetic_energy + totals.affine_kinetic_energy + totals.elastic_energy
