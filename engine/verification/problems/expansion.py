"""Free expansion of rubble, and its return to its start (engine/physics.md, section 1)."""

from dataclasses import dataclass

import numpy as np

from engine.scene.bodies import Sphere
from engine.scene.scene import Physics, Scene
from engine.simulation.initial_conditions import initial_state
from engine.verification.check import Check
from engine.verification.harness import Array, Harness, State


@dataclass(frozen=True)
class Expansion:
    """Rubble with v = H r: J = (1 + H t)^3, ballistic and without stress; reversed at J = 8, it returns to its start.

    Attributes:
        particles: number of particles.
        rate: H [1/s].
    """

    name = "expansion"
    particles: int = 1000
    rate: float = 2e-3

    @property
    def scene(self) -> Scene:
        """Broken rock without gravity, until its size has doubled."""
        body = Sphere(radius=50e3, particles=self.particles, damage=1.0, hydrostatic=False)
        return Scene(bodies=(body,), end_time=1.0 / self.rate, physics=Physics(fracture=None, gravity=None))

    def checks(self, harness: Harness) -> list[Check]:
        """Compare positions, J and stress at J = 8, and again at J = 1."""
        start = initial_state(self.scene)["x"]
        flow = {"v": self.rate * start, "C": np.tile(self.rate * np.eye(3), (self.particles, 1, 1))}
        out = harness.run_until(harness.start(self.scene, **flow), self.scene.end_time)
        back = {**out.fields, "v": -out.v, "C": -out.fields["C"]}
        home = harness.run_until(harness.start(self.scene, **back), self.scene.end_time)
        radius = self.scene.bodies[0].reach
        return [
            *self._compare("out", out, 8.0),
            _distance("out: distance from r (1 + H t), over R", out.x, 2.0 * start, radius),
            *self._compare("back", home, 1.0),
            _distance("back: distance from r, over R", home.x, start, radius),
        ]

    def _compare(self, when: str, state: State, J: float) -> list[Check]:
        worst = float(state.J[np.argmax(np.abs(state.J - J))])
        stress = float(np.abs(state.fields["tau"]).max())
        return [
            Check.absolute(f"{when}: J farthest off", "-", worst, J, 1e-9),
            Check.absolute(f"{when}: largest stress", "Pa", stress, 0.0, 100.0),
        ]


def _distance(quantity: str, x: Array, y: Array, radius: float) -> Check:
    """Largest distance between measured and exact positions, over the radius."""
    return Check.absolute(quantity, "-", float(np.linalg.norm(x - y, axis=1).max()) / radius, 0.0, 1e-10)
