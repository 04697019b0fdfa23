"""Internal energy of particles, or matter that does without (engine/physics.md, section 2)."""

from typing import Any

import taichi as ti

from engine.device.backend import Real


@ti.data_oriented
class InternalEnergy:
    """Specific internal energy [J/kg]: the work of all stress.

    Args:
        particles: state of the particles.
    """

    def __init__(self, particles: Any) -> None:
        self.E = particles.require("E")

    @ti.func
    def after(self, p, work):
        """Energy of particle p after work [J/kg] that is not yet added."""
        return self.E[p] + work

    @ti.func
    def add(self, p, work):
        """Add work [J/kg] to the energy of particle p."""
        self.E[p] = self.E[p] + work  # += would be atomic


@ti.data_oriented
class NoInternalEnergy:
    """Matter whose pressure depends on density alone, and which keeps no energy."""

    @ti.func
    def after(self, p, work):
        """None."""
        return ti.cast(0.0, Real)

    @ti.func
    def add(self, p, work):
        """Work is forgotten."""
