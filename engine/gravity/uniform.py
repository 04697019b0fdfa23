"""Uniform gravity, or none (engine/physics.md, section 11)."""

from typing import Any

import numpy as np
import taichi as ti

from engine.device.backend import vec3
from engine.scene.fields import Vector


@ti.data_oriented
class UniformGravity:
    """The same constant acceleration for all particles.

    Args:
        particles: state of the particles.
        pull: acceleration [m/s^2].
    """

    def __init__(self, particles: Any, pull: Vector) -> None:
        self.particles, self.pull = particles, vec3.field(shape=())
        self.pull[None] = pull

    @ti.func
    def at(self, p):
        """Acceleration of particle p [m/s^2]."""
        return self.pull[None]

    def energy(self) -> float:
        """Return the potential energy [J] of the particles, -sum of m g.x: zero at the origin."""
        state = self.particles.read("x", "mass")
        return -float(np.sum(state["mass"] * (state["x"] @ self.pull.to_numpy())))


@ti.data_oriented
class NoGravity:
    """No gravity: zero acceleration and energy."""

    @ti.func
    def at(self, p):
        """Acceleration of particle p: 0."""
        return vec3(0.0)

    def energy(self) -> float:
        """Return 0."""
        return 0.0
