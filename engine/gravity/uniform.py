"""Gravity that is the same everywhere, or none (engine/physics.md, section 11)."""

from typing import Any

import numpy as np
import taichi as ti

from engine.device.backend import vec3
from engine.scene.fields import Vector


@ti.data_oriented
class UniformGravity:
    """One acceleration for all particles, for ever.

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
        """Potential energy [J] of the particles where they are, relative to the origin."""
        state = self.particles.read("x", "mass")
        return -float(np.sum(state["mass"] * (state["x"] @ self.pull.to_numpy())))


@ti.data_oriented
class Weightless:
    """No gravity."""

    @ti.func
    def at(self, p):
        """None."""
        return vec3(0.0)

    def energy(self) -> float:
        """None."""
        return 0.0
