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

    Attributes:
        half_step_work: work of stress [J/kg] in the second half of the last step, which no kick has taken from the
            motion yet.
    """

    def __init__(self, particles: Particles, takes_heat: bool = True) -> None:
        self.E, self.half_step_work = particles.require("E"), particles.require("half_step_work")
        self.takes_heat = takes_heat

    @ti.func
    def after(self, p, work):
        """Return E[p] + work."""
        return self.E[p] + work

    @ti.func
    def work(self, p, first_half, second_half):
        """Add the work of stress in both halves of a step to E[p]."""
        self.E[p] = self.E[p] + (first_half + second_half)  # += would be atomic
        self.half_step_work[p] = second_half

    @ti.func
    def heat(self, p, heat):
        """Add what the transfer dissipates to E[p]."""
        if ti.static(self.takes_heat):
            self.E[p] = self.E[p] + heat


@ti.data_oriented
class NoInternalEnergy:
    """No internal energy: pressure depends on density alone."""

    @ti.func
    def after(self, p, work):
        """Return zero."""
        return ti.cast(0.0, Real)

    @ti.func
    def work(self, p, first_half, second_half):
        """Do nothing."""

    @ti.func
    def heat(self, p, heat):
        """Do nothing."""
