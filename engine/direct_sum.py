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
                clear(self, first, last)
                for q in range(count):
                    add_ball(self, q, first, last)


@ti.func
def clear(self: ti.template(), first, last):
    """Forget the sums of a range of targets, less the share of each particle's own ball that will be added."""
    for p in range(first, last):
        self.ax[p], self.ay[p], self.az[p] = 0.0, 0.0, 0.0
        self.potential[p] = 1.5 * self.mu[p] / self.radius[None]


@ti.func
def add_ball(self: ti.template(), q, first, last):
    """Add the pull of particle q to a range of targets."""
    x, y, z, mu = self.x[q], self.y[q], self.z[q], self.mu[q]
    ball = self.radius[None] ** 2
    for p in range(first, last):
        dx, dy, dz = x - self.x[p], y - self.y[p], z - self.z[p]
        square = dx * dx + dy * dy + dz * dz
        inverse = 1.0 / ti.sqrt(ti.max(square, ball))
        strength = mu * inverse * inverse * inverse
        self.ax[p] = self.ax[p] + strength * dx
        self.ay[p] = self.ay[p] + strength * dy
        self.az[p] = self.az[p] + strength * dz
        # inside the ball 1/r becomes (3 - r^2/R^2) / 2R; outside the bracket is one
        self.potential[p] = self.potential[p] - mu * inverse * (1.5 - 0.5 * ti.min(square * inverse * inverse, 1.0))
