"""Damage of particles, or none (engine/physics.md, section 5)."""

import taichi as ti

from engine.device.backend import Real
from engine.laws.interfaces import GrowthLaw
from engine.state.particles import Particles


@ti.data_oriented
class Damage:
    """Damage, stored as its cube root, which grows at constant speed.

    Args:
        particles: state of the particles.
        fracture: growth of the cube root.
    """

    def __init__(self, particles: Particles, fracture: GrowthLaw) -> None:
        self.damage_root, self.index, self.fracture = particles.require("damage_root"), particles.index, fracture

    @ti.func
    def value(self, p):
        """Return the cube of the stored root."""
        root = self.damage_root[p]
        return root * root * root

    @ti.func
    def grow(self, p, s, P, dt, body):
        """Store the root that `fracture` returns."""
        self.damage_root[p] = self.fracture.grow(self.damage_root[p], s, P, dt, self.index[p], body)


@ti.data_oriented
class Intact:
    """Matter without damage."""

    @ti.func
    def value(self, p):
        """Return zero."""
        return ti.cast(0.0, Real)

    @ti.func
    def grow(self, p, s, P, dt, body):
        """Do nothing."""
