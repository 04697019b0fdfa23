"""Gravity as a sum over all pairs, exact to round-off; the reference for the tree (engine/physics.md, section 7)."""

import taichi as ti

from engine.device.backend import TASK, on_gpu
from engine.gravity.self_gravity import LANES, SelfGravity
from engine.state.particles import Particles


@ti.data_oriented
class DirectSum(SelfGravity):
    """Sum over all pairs; arguments as `SelfGravity`."""

    def __init__(self, particles: Particles, radius: float) -> None:
        super().__init__(particles, radius, -(-particles.count // LANES) * LANES)
        self.task = 1 if on_gpu() else TASK

    def arrange(self) -> None:
        """Keep the particles in their order, and fill up to a whole row."""
        self.fill_rows(self.count, self.slots)

    @ti.kernel
    def fill_rows(self, count: ti.i32, slots: ti.i32):
        """Set the particle of every slot."""
        for s in range(slots):
            self.particle_of[s] = s
            if s >= count:
                self.particle_of[s] = ~0

    def solve(self, potential: bool) -> None:
        """Sum over all pairs, sources always in the same order; argument as `SelfGravity.solve`."""
        self.sum_pairs(self.count, potential)

    @ti.kernel
    def sum_pairs(self, count: ti.i32, potential: ti.template()):
        """Compute the acceleration or the potential of every particle."""
        for i in range((count + self.lanes - 1) // self.lanes * self.task):
            if i % self.task == 0:
                t = i // self.task * self.lanes
                self.reset(t, potential)
                self.add_balls(0, count, t, potential)
