"""Two bodies falling towards each other (engine/physics.md, sections 7 and 8)."""

from dataclasses import dataclass

import numpy as np

from engine.constants import G_NEWTON
from engine.scene.collision import Collision
from engine.scene.scene import Numerics
from engine.verification.check import Check
from engine.verification.harness import Array, Harness, State

NEAR = 1.25
"""Distance at the end of the fall, in contact distances: no nodes are shared yet."""


@dataclass(frozen=True)
class Infall:
    """The approach of a collision: 195.2 m/s at 4R becomes 200 m/s at 2R.

    Attributes:
        particles: per body.
    """

    name = "orbit"
    particles: int = 2000

    @property
    def collision(self) -> Collision:
        """The collision of equal bodies, with one particle a cell so that they share nodes late."""
        return Collision(
            velocity=200.0, angle=15.0, particles=self.particles, numerics=Numerics(particles_per_cell=1.0)
        )

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the speed at the start, and speed and angle at contact from the energy and momentum of the fall."""
        scene, body = self.collision.scene(), self.collision.bodies_at_contact()[0]
        contact, mu = 2.0 * body.radius, 2.0 * G_NEWTON * body.mass
        start = self.collision.approach()
        fall = (2.0 - NEAR) / (2.0 - 1.0)
        end = harness.run_until(harness.start(scene), scene.start_time * (1.0 - fall))
        x, v = _relative(end)
        speed = float(np.sqrt(v @ v + 2.0 * mu * (1.0 / contact - 1.0 / np.linalg.norm(x))))
        momentum = float(np.linalg.norm(np.cross(x, v)))
        offset = float(np.rad2deg(np.arcsin(momentum / (contact * speed))))
        return [
            Check.absolute("speed at 4R", "m/s", float(np.linalg.norm(start.velocity)), 195.2, 0.05),
            Check.absolute("speed at contact", "m/s", speed, self.collision.velocity, 0.05),
            Check.absolute("impact angle", "deg", offset, self.collision.angle, 0.01),
        ]


def _relative(state: State) -> tuple[Array, Array]:
    """Position [m] and velocity [m/s] of the second body relative to the first."""
    second = state.fields["body"] == 1
    x, v = (values[second].mean(axis=0) - values[~second].mean(axis=0) for values in (state.x, state.v))
    return x, v
