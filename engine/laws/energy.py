"""Internal energy of particles, or none (engine/physics.md, section 2)."""

import taichi as ti

from engine.device.backend import Real
from engine.state.particles import Particles


@ti.data_oriented
class InternalEnergy:
    """Specific internal energy [J/kg], the work of all stress.

    Args:
        particles: state of the particles.
        takes_heat: whether it takes up what the transfer dissipates.
    """

    def __init__(self, particles: Particles, takes_heat: bool = True) -> None:
        self.E, self.takes_heat = particles.require("E"), takes_heat

    @ti.func
    def after(self, p, work):
        """Return E[p] + work."""
        return self.E[p] + work

    @ti.func
    def add(self, p, work):
        """Add work to E[p]."""
        self.E[p] = self.E[p] + work  # += would be atomic

    @ti.func
    def heat(self, p, heat):
        """Add what the transfer dissipates to E[p]."""
        if ti.static(self.takes_heat):
            self.add(p, heat)


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

    @ti.func
    def heat(self, p, heat):
        """Do nothing."""
