"""Free rotation of an elastic sphere (engine/physics.md, section 1)."""

from dataclasses import dataclass

import numpy as np

from engine.body import Body
from engine.ledger import Totals
from engine.scene import Numerics, Physics, Scene
from engine.verification.check import Check, share
from engine.verification.drive import begin, fitted_order, follow


@dataclass(frozen=True)
class Rotation:
    """A sphere turns once about a skew axis: angular momentum and energy are constant.

    Known disagreement: motion and strain keep their energy, but the work of stress does not. It takes the strain of a
    step to be dt sym(L), and a rotation has dt^2 L L^T / 2 besides, so internal energy falls by about rate x dt of the
    kinetic energy per radian.

    Attributes:
        particles: number of particles.
        rate: angular velocity [rad/s]; the surface moves at 100 m/s.
        cfl: time steps, in units of the time a wave needs for one cell.
    """

    name = "rotation"
    particles: int = 1000
    rate: float = 2e-3
    cfl: tuple[float, float] = (0.5, 0.25)

    def scene(self, cfl: float) -> Scene:
        """One turn without gravity."""
        spin = (self.rate / 3.0, 2.0 * self.rate / 3.0, 2.0 * self.rate / 3.0)
        body = Body(radius=50e3, particles=self.particles, spin=spin, hydrostatic=False)
        physics = Physics(strength=False, fracture=None, gravity=None)
        return Scene(bodies=(body,), end_time=2.0 * np.pi / self.rate, physics=physics, numerics=Numerics(cfl=cfl))

    def turn(self, cfl: float) -> tuple[Totals, Totals]:
        """Totals before and after one turn."""
        scene = self.scene(cfl)
        simulation = begin(scene)
        start = simulation.totals()
        follow(simulation, scene.end_time)
        return start, simulation.totals()

    def checks(self) -> list[Check]:
        """Angular momentum and energies after one turn, and the order in dt of what total energy loses."""
        start, end = self.turn(self.cfl[0])
        losses = [_loss(start, end), _loss(*self.turn(self.cfl[1]))]
        order = fitted_order(list(self.cfl), losses)
        before = float(np.linalg.norm(start.angular_momentum))
        change = float(np.linalg.norm(end.angular_momentum - start.angular_momentum))
        return [
            Check("angular momentum", "kg m2/s", before + change, before, change / before, 1e-12),
            share("kinetic and elastic energy", "J", _motion(end), _motion(start), 1e-3),
            Check("total energy", "J", end.total_energy, start.total_energy, losses[0], 1e-3),
            Check("order in dt of the total energy", "-", order, 1.0, max(0.0, 1.0 - order), 0.1),
        ]


def _motion(totals: Totals) -> float:
    """Energy [J] of motion and of strain."""
    return totals.kinetic_energy + totals.affine_kinetic_energy + totals.elastic_energy


def _loss(start: Totals, end: Totals) -> float:
    """Share of the total energy that is gone."""
    return abs(end.total_energy / start.total_energy - 1.0)
