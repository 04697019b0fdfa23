"""The usual MPM step, to compare with: one dense box of nodes, cleared each step, and atomic adds in particle order.

Equations are those of `engine.mpm.apic` (engine/physics.md, section 1); the grid, the order of particles and the way
momentum gets there are not. A particle that shares no node with another is nothing special here.
"""

from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.device.backend import mat3, vec3, vec4
from engine.device.tensors import unpack
from engine.mpm.affine import affine_velocity
from engine.mpm.spline import spline_weights
from engine.state.particles import Particles

MARGIN = 2
"""Cells by which particles may leave the box that holds them at first."""


@ti.data_oriented
class DenseTransfer:
    """The kernels of one time step.

    Args:
        particles: state of the particles.
        constitution: response of one particle, with the interface of `engine.laws.constitution`.
        gravity: acceleration of one particle, likewise.
        dx: grid spacing [m].
    """

    def __init__(self, particles: Particles, constitution: Any, gravity: Any, dx: float) -> None:
        self.particles, self.constitution, self.gravity, self.dx = particles, constitution, gravity, dx
        lowest, shape = _box(particles.read("x")["x"], dx)
        self.lowest = ti.Vector(lowest)
        self.nodes = vec4.field(shape=shape)

    def step(self, dt: float, kick: float) -> None:
        """Advance all particles by one time step [s], in which forces act for the time of a kick [s]."""
        self.clear()
        self.particles_to_grid(kick)
        self.update_grid()
        self.grid_to_particles(dt)

    @ti.kernel
    def clear(self):
        """Empty all nodes."""
        for node in ti.grouped(self.nodes):
            self.nodes[node] = vec4(0.0)

    @ti.kernel
    def particles_to_grid(self, kick: ti.f64):
        """Mass and momentum, with the momentum that stress adds over the step."""
        for p in range(self.particles.count):
            base, f = self.locate(p)
            weights = spline_weights(f)
            mass = self.particles.mass[p]
            volume = mass / self.constitution.rho0(p)
            stress = (4.0 * kick * volume / (self.dx * self.dx)) * unpack(self.particles.tau[p])
            affine = mass * self.particles.C[p] - stress
            momentum = mass * (self.particles.v[p] + kick * self.gravity.at(p))
            for i, j, k in ti.static(ti.ndrange(3, 3, 3)):
                weight = weights[0, i] * weights[1, j] * weights[2, k]
                m = momentum + affine @ (self.dx * (vec3(i, j, k) - f))
                ti.atomic_add(self.nodes[base + ti.Vector([i, j, k])], weight * vec4(m[0], m[1], m[2], mass))

    @ti.kernel
    def update_grid(self):
        """Turn momentum into velocity."""
        for node in ti.grouped(self.nodes):
            total = self.nodes[node]
            if total[3] > 0.0:
                self.nodes[node] = vec4(total[0] / total[3], total[1] / total[3], total[2] / total[3], total[3])

    @ti.kernel
    def grid_to_particles(self, dt: ti.f64):
        """Move and deform every particle with the velocity of its nodes."""
        for p in range(self.particles.count):
            base, f = self.locate(p)
            weights = spline_weights(f)
            v, L = vec3(0.0), mat3(0.0)
            for i, j, k in ti.static(ti.ndrange(3, 3, 3)):
                node = self.nodes[base + ti.Vector([i, j, k])]
                weighted = weights[0, i] * weights[1, j] * weights[2, k] * vec3(node[0], node[1], node[2])
                v += weighted
                L += 4.0 / self.dx * weighted.outer_product(vec3(i, j, k) - f)
            self.particles.x[p] = self.particles.x[p] + dt * v
            self.particles.v[p] = v
            self.particles.C[p] = affine_velocity(L, dt, self.particles.j[p], 1.0 / dt)
            self.constitution.update(p, L, dt)

    @ti.func
    def locate(self, p):
        """Lowest node of particle p in the box, and the particle's distance from it in cells."""
        scaled = self.particles.x[p] / self.dx
        base = ti.floor(scaled - 0.5, ti.i32)
        return base - self.lowest, scaled - base


def _box(x: NDArray[np.float64], dx: float) -> tuple[list[int], tuple[int, ...]]:
    """Lowest node and number of nodes of the smallest box around the particles, and a margin."""
    base = np.floor(x / dx - 0.5).astype(int)
    lowest, highest = base.min(axis=0) - MARGIN, base.max(axis=0) + 2 + MARGIN
    return lowest.tolist(), tuple((highest - lowest + 1).tolist())
