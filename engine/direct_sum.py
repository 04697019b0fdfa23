"""Gravity as a sum over all pairs: exact to round-off, and what the tree is measured against."""

from typing import Any

import numpy as np
import taichi as ti

from engine.backend import TASK, on_gpu
from engine.gravity import Places, SelfGravity, Vectors

GROUP = 64
"""Targets that one CPU thread serves in one pass over the sources: their sums stay in the nearest cache."""


@ti.data_oriented
class DirectSum(SelfGravity):
    """Sum over all pairs; arguments as `SelfGravity`."""

    def __init__(self, particles: Any, radius: float) -> None:
        super().__init__(particles, radius, particles.count)
        self.group, self.task = (1, 1) if on_gpu() else (GROUP, TASK)

    def arrange(self, x: Vectors) -> Places:
        """Any order will do."""
        return np.arange(len(x))

    def solve(self) -> None:
        """Sum over all pairs, sources always in the same order."""
        self.sum_pairs(self.count)

    @ti.kernel
    def sum_pairs(self, count: ti.i32):
        """Acceleration and potential of every particle."""
        for t in range((count + self.group - 1) // self.group * self.task):
            if t % self.task == 0:
                first = t // self.task * self.group
                last = ti.min(first + self.group, count)
                self.clear(first, last)
                for q in range(count):
                    self.add_ball(q, first, last)
