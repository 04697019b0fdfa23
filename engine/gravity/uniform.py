"""Uniform gravity, or none (engine/physics.md, section 11)."""

import taichi as ti

from engine.arrays import Vector as Moment
from engine.device.backend import vec3
from engine.device.fields import allocate
from engine.scene.fields import Vector


@ti.data_oriented
class UniformGravity:
    """The same constant acceleration for all particles.

    Args:
        acceleration: [m/s^2].
    """

    def __init__(self, acceleration: Vector) -> None:
        self.acceleration = allocate(vec3)
        self.acceleration[None] = acceleration

    @ti.func
    def at(self, p):
        """Return the acceleration of every particle."""
        return self.acceleration[None]

    def energy(self, moment: Moment) -> float:
        """Return -sum of m g.x [J], zero at the origin."""
        return -float(moment @ self.acceleration.to_numpy())


@ti.data_oriented
class NoGravity:
    """No gravity: zero acceleration and energy."""

    @ti.func
    def at(self, p):
        """Return zero."""
        return vec3(0.0)

    def energy(self, moment: Moment) -> float:
        """Return zero."""
        return 0.0
