"""Internal energy of particles, or none (engine/physics.md, section 2)."""

import taichi as ti

from engine.device.backend import Real
from engine.state.particles import Particles


@ti.data_oriented
class InternalEnergy:
    """Specific internal energy [J/kg], the work of all stress.

    Args:
        particles: state of the particles.
    """

    def __init__(self, particles: Particles) -> None:
        self.E = particles.require("E")

    @ti.func
    def after(self, p, work):
        """Return E[p] + work."""
        return self.E[p] + work

    @ti.func
    def add(self, p, work):
        """Add work to E[p]."""
        self.E[p] = self.E[p] + work  # += would be atomic


@ti.data_oriented
class NoInternalEnergy:
    """No internal energy: pressure depends on density alone."""

    @ti.func
    def after(self, p, work):
        """Return zero."""
        return ti.cast(0.0, Real)

    @ti.func
    def add(self, p, work):
        """Do nothing."""
