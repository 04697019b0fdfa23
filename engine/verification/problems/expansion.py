"""Free expansion of rubble, and its fall back to where it began (engine/physics.md, section 1)."""

from dataclasses import dataclass

import numpy as np

from engine.scene.bodies import Sphere
from engine.scene.scene import Physics, Scene
from engine.simulation.initial_conditions import initial_state
from engine.verification.check import Check, difference
from engine.verification.harness import Moment, begin, follow


@dataclass(frozen=True)
class Expansion:
    """Rubble with v = H r: J = (1 + H t)^3, ballistic and without stress; turned around at J = 8, it is itself again.

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

    def checks(self) -> list[Check]:
        """Size, J and stress at J = 8, and again at J = 1."""
        start = initial_state(self.scene)["x"]
        flow = {"v": self.rate * start, "C": np.tile(self.rate * np.eye(3), (self.particles, 1, 1))}
        out = follow(begin(self.scene, **flow), self.scene.end_time)
        back = {**out.state, "v": -out.v, "C": -out.state["C"]}
        home = follow(begin(self.scene, **back), self.scene.end_time)
        radius = self.scene.bodies[0].reach
        return [
            *self._compare("out", out, 8.0),
            difference("out: distance from r (1 + H t), over R", "-", _apart(out.x, 2.0 * start) / radius, 0.0, 1e-10),
            *self._compare("back", home, 1.0),
            difference("back: distance from r, over R", "-", _apart(home.x, start) / radius, 0.0, 1e-10),
        ]

    def _compare(self, when: str, moment: Moment, J: float) -> list[Check]:
        worst = float(moment.J[np.argmax(np.abs(moment.J - J))])
        stress = float(np.abs(moment.state["tau"]).max())
        return [
            difference(f"{when}: J farthest off", "-", worst, J, 1e-9),
            difference(f"{when}: largest stress", "Pa", stress, 0.0, 100.0),
        ]


def _apart(x: np.ndarray, y: np.ndarray) -> float:
    """Largest distance [m] between two sets of positions."""
    return float(np.linalg.norm(x - y, axis=1).max())
