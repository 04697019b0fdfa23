"""Energy that motion loses, by cause, or no account of it (engine/physics.md, section 2)."""

import taichi as ti

from engine.state.particles import Particles


@ti.data_oriented
class Dissipation:
    """Specific energy [J/kg] that the motion of each particle has lost since the start.

    Args:
        particles: state of the particles.
        by_transfer, by_plasticity, by_viscosity: whether the scene has this cause.
    """

    def __init__(self, particles: Particles, by_transfer: bool, by_plasticity: bool, by_viscosity: bool) -> None:
        self.by_transfer, self.by_plasticity, self.by_viscosity = by_transfer, by_plasticity, by_viscosity
        if by_transfer:
            self.transfer_heat, self.affine_loss = particles.require("transfer_heat"), particles.require("affine_loss")
        if by_plasticity:
            self.plastic_heat = particles.require("plastic_heat")
        if by_viscosity:
            self.viscous_heat = particles.require("viscous_heat")

    @ti.func
    def transfer(self, p, heat):
        """Add heat [J/kg] of the transfer."""
        if ti.static(self.by_transfer):
            self.transfer_heat[p] = self.transfer_heat[p] + heat  # += would be atomic

    @ti.func
    def drift(self, p, loss):
        """Add what the affine motion loses [J/kg] as particles move."""
        if ti.static(self.by_transfer):
            self.affine_loss[p] = self.affine_loss[p] + loss

    @ti.func
    def stress(self, p, plastic, viscous):
        """Add heat [J/kg] of plastic and of viscous flow."""
        if ti.static(self.by_plasticity):
            self.plastic_heat[p] = self.plastic_heat[p] + plastic
        if ti.static(self.by_viscosity):
            self.viscous_heat[p] = self.viscous_heat[p] + viscous


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
