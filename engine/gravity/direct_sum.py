"""Gravity as a sum over all pairs, exact to round-off; the reference for the tree (engine/physics.md, section 7)."""

import numpy as np
import taichi as ti

from engine.arrays import Indices, Vectors
from engine.device.backend import TASK, on_gpu
from engine.gravity.self_gravity import LANES, SelfGravity
from engine.state.particles import Particles


@ti.data_oriented
class DirectSum(SelfGravity):
    """Sum over all pairs; arguments as `SelfGravity`."""

    def __init__(self, particles: Particles, radius: float) -> None:
        super().__init__(particles, radius, -(-particles.count // LANES) * LANES)
        self.task = 1 if on_gpu() else TASK

    def arrange(self, x: Vectors) -> Indices:
        """Return the particles in their own order, and padding up to a whole row; shapes as `SelfGravity.arrange`."""
        return np.concatenate([np.arange(len(x)), np.full(-len(x) % LANES, ~0)])

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
