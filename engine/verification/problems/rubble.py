"""Rubble sheared without gravity (engine/physics.md, section 1)."""

from dataclasses import dataclass

import numpy as np

from engine.scene.collision import Collision
from engine.scene.scene import Physics, Scene
from engine.verification.check import Check
from engine.verification.harness import Harness


@dataclass(frozen=True)
class Rubble:
    """Two piles of rubble graze each other: total angular momentum is constant.

    Attributes:
        particles: per body.
        end_time: after contact [s].
    """

    name = "rubble"
    particles: int = 300
    end_time: float = 1200.0

    @property
    def scene(self) -> Scene:
        """A collision at (200 m/s, 15 deg) of broken bodies."""
        scene = Collision(
            velocity=200.0,
            angle=15.0,
            particles=self.particles,
            start_separation=1.2,
            end_time=self.end_time,
            gravity=None,
        ).scene()
        broken = tuple(body.model_copy(update={"damage": 1.0}) for body in scene.bodies)
        return scene.model_copy(update={"bodies": broken, "physics": Physics(fracture=None, gravity=None)})

    def drift(self, harness: Harness) -> tuple[float, float]:
        """Return the angular momentum about z [kg m^2/s], affine part included, before and after."""
        simulation = harness.start(self.scene)
        before = simulation.totals().angular_momentum
        harness.run_until(simulation, self.end_time)
        return float(before[2]), float(simulation.totals().angular_momentum[2])

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the angular momentum with that before, to round-off."""
        before, after = self.drift(harness)
        return [Check("angular momentum", "kg m2/s", after, before, float(np.abs(after / before - 1.0)), 1e-12)]
