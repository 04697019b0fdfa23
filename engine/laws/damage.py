"""Damage of particles, or matter that has none (engine/physics.md, section 5)."""

from typing import Any

import taichi as ti

from engine.device.backend import Real


@ti.data_oriented
class Damage:
    """Damage as its cube root, which grows at constant speed.

    Args:
        particles: state of the particles.
        fracture: growth of damage.
    """

    def __init__(self, particles: Any, fracture: Any) -> None:
        self.damage_root, self.index, self.fracture = particles.require("damage_root"), particles.index, fracture

    @ti.func
    def value(self, p):
        """Damage of particle p [-]."""
        root = self.damage_root[p]
        return root * root * root

    @ti.func
    def grow(self, p, s, P, dt, body):
        """Break particle p further, under deviatoric Cauchy stress s [Pa] and pressure P [Pa], for a step dt [s]."""
        self.damage_root[p] = self.fracture.grow(self.damage_root[p], s, P, dt, self.index[p], body)


@ti.data_oriented
class Intact:
    """Matter that is whole and never breaks."""

    @ti.func
    def value(self, p):
        """None."""
        return ti.cast(0.0, Real)

    @ti.func
    def grow(self, p, s, P, dt, body):
        """Nothing breaks."""
