"""Self-gravity as a direct sum over all pairs (engine/physics.md, section 7)."""

from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.backend import TASK, Real, capacity, on_gpu
from engine.orbit import G

GROUP = 64
"""Targets that one CPU thread serves in one pass over the sources: their sums stay in the nearest cache."""


@ti.data_oriented
class DirectSum:
    """Pull of every particle, taken as a homogeneous ball of one radius, on every other.

    Args:
        particles: state of the particles.
        radius: radius of the ball [m]: the field is Newton's outside and linear inside.
    """

    def __init__(self, particles: Any, radius: float) -> None:
        self.particles, self.count = particles, particles.count
        self.group, self.task = (1, 1) if on_gpu() else (GROUP, TASK)
        self.radius = ti.field(Real, ())
        self.radius[None] = radius
        shape = capacity(particles.count)
        self.x, self.y, self.z, self.mu = (ti.field(Real, shape) for _ in range(4))
        self.ax, self.ay, self.az, self.potential = (ti.field(Real, shape) for _ in range(4))

    def accelerate(self, ahead: float) -> None:
        """Set every particle's acceleration to the pull at positions a time `ahead` [s] of now, without net force."""
        pull = self.pull(ahead)
        mean = np.average(pull, axis=0, weights=self.particles.read("mass")["mass"])
        self.particles.write({"acceleration": pull - mean})

    def pull(self, ahead: float) -> NDArray[np.float64]:
        """Acceleration [m/s^2] at positions a time `ahead` [s] of now, shape [particle_count, 3]."""
        self.collect_sources(self.count, ahead)
        self.sum_pairs(self.count)
        return np.stack([a.to_numpy()[: self.count] for a in (self.ax, self.ay, self.az)], axis=1)

    def energy(self) -> float:
        """Gravitational energy [J] of the particles where they are."""
        self.collect_sources(self.count, 0.0)
        self.sum_pairs(self.count)
        mass = self.particles.read("mass")["mass"]
        return 0.5 * float(np.sum(mass * self.potential.to_numpy()[: self.count]))

    @ti.kernel
    def collect_sources(self, count: ti.i32, ahead: ti.f64):
        """Positions and masses, each component by itself."""
        for p in range(count):
            x = self.particles.x[p] + ahead * self.particles.v[p]
            self.x[p], self.y[p], self.z[p] = x[0], x[1], x[2]
            self.mu[p] = G * self.particles.mass[p]

    @ti.kernel
    def sum_pairs(self, count: ti.i32):
        """Acceleration and potential of every particle, sources always in the same order."""
        for t in range((count + self.group - 1) // self.group * self.task):
            if t % self.task == 0:
                first = t // self.task * self.group
                last = ti.min(first + self.group, count)
                for p in range(first, last):
                    self.ax[p], self.ay[p], self.az[p] = 0.0, 0.0, 0.0
                    self.potential[p] = 1.5 * self.mu[p] / self.radius[None]  # takes out the particle's own share
                for q in range(count):
                    self.add_source(q, first, last)

    @ti.func
    def add_source(self, q, first, last):
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
