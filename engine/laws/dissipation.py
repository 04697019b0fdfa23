"""Energy that motion loses, by cause, or no account of it (engine/physics.md, section 2)."""

import taichi as ti

from engine.state.particles import Particles


@ti.data_oriented
class Dissipation:
    """Specific energy [J/kg] that the motion of each particle has lost since the start.

    Args:
        particles: state of the particles.
    """

    def __init__(self, particles: Particles) -> None:
        self.by_transfer = particles.require("transfer_heat")
        self.by_plasticity = particles.require("plastic_heat")
        self.by_viscosity = particles.require("viscous_heat")
        self.by_drift = particles.require("affine_loss")

    @ti.func
    def transfer(self, p, heat):
        """Add heat [J/kg] of the transfer."""
        self.by_transfer[p] = self.by_transfer[p] + heat  # += would be atomic

    @ti.func
    def drift(self, p, loss):
        """Add what the affine motion loses [J/kg] as particles move."""
        self.by_drift[p] = self.by_drift[p] + loss

    @ti.func
    def stress(self, p, plastic, viscous):
        """Add heat [J/kg] of plastic and of viscous flow."""
        self.by_plasticity[p] = self.by_plasticity[p] + plastic
        self.by_viscosity[p] = self.by_viscosity[p] + viscous


@ti.data_oriented
class NoDissipation:
    """No account of dissipation."""

    @ti.func
    def transfer(self, p, heat):
        """Do nothing."""

    @ti.func
    def drift(self, p, loss):
        """Do nothing."""

    @ti.func
    def stress(self, p, plastic, viscous):
        """Do nothing."""
