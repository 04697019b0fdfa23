"""Quadratic-spline affine MPM: momentum to the grid and back (engine/physics.md, section 1; Jiang et al. 2015).

Each block of particles adds to its own copy of the nodes it touches; one pass over the tiles sums the copies in a
fixed order and writes the common velocity back into each. On the CPU one thread works on one block at a time, so no two
threads ever add to the same number and results do not depend on their count.
"""

from typing import Any

import numpy as np
import taichi as ti
import taichi.math as tm

from engine.device.backend import EPSILON, TASK, Real, mat3, on_gpu, vec3, vec4
from engine.device.fields import capacity, overwrite
from engine.device.tensors import determinant_increment, identity, norm_squared, symmetric, unpack
from engine.mpm.blocks import Blocks
from engine.mpm.spline import moments, own_share, spline_weights
from engine.state.clock import FAULT_INVERTED, Clock

SPAN = 8
"""Nodes along an edge of a block's copy."""
COPY = SPAN**3
TILE = 64

LARGEST_INCREMENT = 0.3
"""Largest deformation |dt L| of one step [-]."""

ALONE = 50.0 * EPSILON
"""Share of a particle's mass below which what others have on the same nodes is round-off.

The smaller of both masses at a node bounds the momentum they can exchange there, so that none is lost with them.
"""

MIXED = 1e-3
"""Mean mass of others on a particle's nodes, in units of its own, above which it is surely not alone."""

ROUNDING = max(1e-9, 100.0 * EPSILON)
"""Relative difference of energies that are equal but for round-off."""


@ti.data_oriented
class Transfer:
    """The kernels of one time step.

    Args:
        particles: state of the particles.
        constitution: response of one particle.
        gravity: acceleration of one particle.
        clock: time and time step.
        walls: rigid planes, or `None`.
        dx: grid spacing [m].
        cfl: time step in units of the time a wave needs for one cell.
        blocks: number of blocks to make room for.
    """

    def __init__(
        self,
        particles: Any,
        constitution: Any,
        gravity: Any,
        clock: Clock,
        walls: Any,
        dx: float,
        cfl: float,
        blocks: int,
    ) -> None:
        self.particles, self.constitution, self.gravity = particles, constitution, gravity
        self.clock, self.walls = clock, walls
        self.by_block, self.has_walls = not on_gpu(), walls is not None
        self.capacity = capacity(blocks)
        self.dx, self.cfl = ti.field(ti.f64, ()), ti.field(Real, ())
        self.dx[None], self.cfl[None] = dx, cfl
        self.block_count, self.tile_count = ti.field(ti.i32, ()), ti.field(ti.i32, ())
        self.shared_count, self.alone_count = ti.field(ti.i32, ()), ti.field(ti.i32, ())
        self.owner = ti.field(ti.i32, particles.x.shape)
        self.origin = ti.Vector.field(3, ti.i32, self.capacity)
        self.first = ti.field(ti.i32, self.capacity + 1)
        self.source = ti.field(ti.i32, (8 * self.capacity, 8))
        self.nodes = vec4.field(shape=self.capacity * COPY)

    def use(self, blocks: Blocks) -> None:
        """Take over newly built blocks, in whose order the particles lie; there must be room for them."""
        shared = int(blocks.first[-1])
        counts = (self.block_count, self.tile_count, self.shared_count, self.alone_count)
        sizes = (len(blocks.origin), len(blocks.source), shared, len(blocks.order) - shared)
        for field, size in zip(counts, sizes, strict=True):
            field[None] = size
        owner = np.repeat(np.arange(len(blocks.origin), dtype=np.int32), np.diff(blocks.first))
        overwrite(self.owner, owner)
        overwrite(self.origin, blocks.origin)
        overwrite(self.first, blocks.first)
        overwrite(self.source, blocks.source)

    def step(self) -> None:
        """Advance all particles by one time step, unless the clock says to pause."""
        self.particles_to_grid()
        self.update_grid()
        self.grid_to_particles()

    @ti.kernel
    def particles_to_grid(self):
        """Mass and momentum, with the momentum that stress adds over the step."""
        self.clock.begin_step()
        blocks = self.block_count[None] * self.clock.running[None]
        if ti.static(self.by_block):
            for t in range(blocks * TASK):
                if t & (TASK - 1) == 0:
                    self.fill_block(t // TASK)
        else:
            for n in range(blocks * COPY):
                self.nodes[n] = vec4(0.0)
            for k in range(self.shared_count[None] * self.clock.running[None]):
                self.scatter(k, self.owner[k])

    @ti.kernel
    def update_grid(self):
        """Sum the copies of every node and turn momentum into velocity."""
        for n in range(self.tile_count[None] * TILE * self.clock.running[None]):
            tile = n // TILE
            inner = (((n >> 4) & 3) * SPAN + ((n >> 2) & 3)) * SPAN + (n & 3)
            total = vec4(0.0)
            for corner in range(8):
                b = self.source[tile, corner]
                if b >= 0:
                    total += self.nodes[b * COPY + corner_offset(corner) + inner]
            if total[3] > 0.0:
                velocity = vec3(total[0] / total[3], total[1] / total[3], total[2] / total[3])
                if ti.static(self.has_walls):
                    velocity = self.walls.hold(self.place(tile, n), velocity)
                result = vec4(velocity, total[3])
                for corner in range(8):
                    b = self.source[tile, corner]
                    if b >= 0:
                        self.nodes[b * COPY + corner_offset(corner) + inner] = result

    @ti.func
    def place(self, tile, n):
        """Position of node n of a tile [m]."""
        node = ti.Vector([(n >> 4) & 3, (n >> 2) & 3, n & 3])
        first = ti.Vector([0, 0, 0])
        for corner in range(8):
            b = self.source[tile, corner]
            if b >= 0:
                first = 4 * (self.origin[b] + ti.Vector([corner >> 2, (corner >> 1) & 1, corner & 1])) - 1
        return self.dx[None] * ti.cast(first + node, ti.f64)

    @ti.kernel
    def grid_to_particles(self):
        """Move and deform every particle with the velocity of its nodes."""
        if ti.static(self.by_block):
            for t in range(self.block_count[None] * self.clock.running[None] * TASK):
                if t & (TASK - 1) == 0:
                    self.report(self.empty_block(t // TASK))
        else:
            for k in range(self.shared_count[None] * self.clock.running[None]):
                self.report(self.gather(k, self.owner[k]))
        for k in range(self.alone_count[None] * self.clock.running[None]):
            p = self.shared_count[None] + k
            self.report(self.drift(p))
            self.check_place(p)

    @ti.func
    def fill_block(self, b):
        """Collect the particles of block b on its nodes."""
        for n in range(b * COPY, (b + 1) * COPY):
            self.nodes[n] = vec4(0.0)
        for p in range(self.first[b], self.first[b + 1]):
            self.scatter(p, b)

    @ti.func
    def empty_block(self, b):
        """Advance the particles of block b; returns the tightest limits of their time step."""
        limits = vec4(0.0)
        for p in range(self.first[b], self.first[b + 1]):
            limits = ti.max(limits, self.gather(p, b))
        return limits

    @ti.func
    def report(self, limits):
        """Tell the clock how long the next step may be.

        Args:
            limits: speed of signals [m/s], squares of velocity gradient [1/s^2] and of acceleration [m^2/s^4],
                diffusivity [m^2/s].
        """
        dx = ti.cast(self.dx[None], Real)
        wave, deformation = limits[0] / (self.cfl[None] * dx), ti.sqrt(limits[1]) / LARGEST_INCREMENT
        fall, diffusion = ti.sqrt(ti.sqrt(limits[2]) / dx), 6.0 * limits[3] / (dx * dx)
        self.clock.report_rate(ti.max(wave, deformation, fall, diffusion))

    @ti.func
    def locate(self, p, origin):
        """Lowest node of particle p within its block's copy, and the particle's distance from it in cells."""
        scaled = self.particles.x[p] / self.dx[None]
        base = ti.floor(scaled - 0.5, ti.i32)
        return base - 4 * origin + 1, ti.cast(scaled - ti.cast(base, ti.f64), Real)

    @ti.func
    def scatter(self, p, b):
        """Add particle p to the nodes of block b, axis by axis: what is added is linear in the distance from it."""
        dx = ti.cast(self.dx[None], Real)
        local, f = self.locate(p, self.origin[b])
        w = spline_weights(f)
        mass, dt = self.particles.mass[p], self.clock.dt[None]
        volume = mass / self.constitution.table[self.particles.body[p]].rho0
        affine = (mass * dx) * self.particles.C[p] - (4.0 * dt * volume / dx) * unpack(self.particles.tau[p])
        momentum = mass * (self.particles.v[p] + dt * self.gravity.at(p)) - affine @ f
        corner = vec4(momentum, mass)
        by_x, by_y, by_z = vec4(affine[:, 0], 0.0), vec4(affine[:, 1], 0.0), vec4(affine[:, 2], 0.0)
        start = b * COPY + (local[0] * SPAN + local[1]) * SPAN + local[2]
        for i in range(3):
            for j in ti.static(range(3)):
                weight = w[0, i] * w[1, j]
                row = weight * (corner + i * by_x + j * by_y)
                row_by_z = weight * by_z
                for k in ti.static(range(3)):
                    n = start + (i * SPAN + j) * SPAN + k
                    value = w[2, k] * (row + k * row_by_z)
                    if ti.static(self.by_block):
                        self.nodes[n] = self.nodes[n] + value
                    else:
                        ti.atomic_add(self.nodes[n], value)

    @ti.func
    def gather(self, p, b):
        """Advance particle p with the velocity of its nodes, summed axis by axis; returns its limits of the step."""
        local, f = self.locate(p, self.origin[b])
        w = spline_weights(f)
        w_z, d_x, d_y, d_z = w[2, :], moments(w[0, :], f[0]), moments(w[1, :], f[1]), moments(w[2, :], f[2])
        v, by_x, by_y, by_z = vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0)
        start = b * COPY + (local[0] * SPAN + local[1]) * SPAN + local[2]
        for i in range(3):
            plane, plane_by_y, plane_by_z = vec4(0.0), vec4(0.0), vec4(0.0)
            for j in ti.static(range(3)):
                n = start + (i * SPAN + j) * SPAN
                first, second, third = self.nodes[n], self.nodes[n + 1], self.nodes[n + 2]
                row = w_z[0] * first + w_z[1] * second + w_z[2] * third
                row_by_z = d_z[0] * first + d_z[1] * second + d_z[2] * third
                plane += w[1, j] * row
                plane_by_y += d_y[j] * row
                plane_by_z += w[1, j] * row_by_z
            v += w[0, i] * plane
            by_x += d_x[i] * plane
            by_y += w[0, i] * plane_by_y
            by_z += w[0, i] * plane_by_z
        mass = self.particles.mass[p]
        alone, limits = False, vec4(0.0)
        if v[3] - mass * own_share(w) <= MIXED * mass:
            alone = self.shared_mass(mass, w, start) <= ALONE * mass
        if alone:
            limits = self.drift(p)
        else:
            per_dx = 4.0 / ti.cast(self.dx[None], Real)
            L = per_dx * mat3(by_x[0], by_y[0], by_z[0], by_x[1], by_y[1], by_z[1], by_x[2], by_y[2], by_z[2])
            limits = self.move(p, vec3(v[0], v[1], v[2]), L)
        self.check_place(p)
        return limits

    @ti.func
    def shared_mass(self, mass, w, start):
        """Sum over the nodes of a particle of the smaller of its own and all others' mass [kg]."""
        shared = ti.cast(0.0, Real)
        for i in range(3):
            for j in range(3):
                for k in ti.static(range(3)):
                    own = w[0, i] * w[1, j] * w[2, k] * mass
                    shared += ti.min(own, self.nodes[start + (i * SPAN + j) * SPAN + k][3] - own)
        return shared

    @ti.func
    def move(self, p, v, L):
        """Give particle p its new velocity and velocity gradient, and deform it; returns its limits of the step."""
        dt = self.clock.dt[None]
        self.particles.x[p] = self.particles.x[p] + dt * v  # += would be atomic
        self.particles.v[p] = v
        self.particles.C[p] = affine_velocity(L, dt, self.particles.j[p])
        c, diffusivity = self.constitution.update(p, L, dt)
        if not self.particles.j[p] > -1.0 or tm.isinf(self.particles.j[p]):
            self.clock.report_fault(FAULT_INVERTED, self.particles.index[p])
        deformation = ti.max(norm_squared(L), self.release(p))
        return vec4(c + v.norm(), deformation, self.gravity.at(p).norm_sqr(), diffusivity)

    @ti.func
    def drift(self, p):
        """A particle that shares no node with another is ballistic: its strain rests, its spin stays.

        A wall holds it back before it is behind. Its speed limits the time step, lest it passes another unseen; so does
        its state, lest they meet in a long one.
        """
        dt = self.clock.dt[None]
        v = self.particles.v[p] + dt * self.gravity.at(p)
        if ti.static(self.has_walls):
            v = self.walls.hold(self.particles.x[p] + dt * v, v)
        self.particles.x[p] = self.particles.x[p] + dt * v
        self.particles.v[p] = v
        self.particles.C[p] = 0.5 * (self.particles.C[p] - self.particles.C[p].transpose())
        return vec4(self.constitution.signal_speed(p) + v.norm(), self.release(p), 0.0, 0.0)

    @ti.func
    def release(self, p):
        """Square [1/s^2] of the velocity gradient that limits the step as the stress of particle p, let loose, does."""
        dx, rho0 = ti.cast(self.dx[None], Real), self.constitution.table[self.particles.body[p]].rho0
        growth = 4.0 * ti.sqrt(norm_squared(unpack(self.particles.tau[p]))) / (rho0 * dx * dx)
        return LARGEST_INCREMENT * growth

    @ti.func
    def check_place(self, p):
        """Ask for new blocks once particle p has left its block by a cell."""
        base = ti.floor(self.particles.x[p] / self.dx[None] - 0.5, ti.i32)
        local = base - 4 * self.particles.origin[p] + 1
        if local.min() < 0 or local.max() > SPAN - 3:
            self.clock.moved_out[None] = 1


@ti.func
def corner_offset(corner):
    """Place of a tile inside the copy of the block at one of its eight corners."""
    return ((corner >> 2) * SPAN + ((corner >> 1) & 1)) * SPAN * 4 + (corner & 1) * 4


@ti.func
def affine_velocity(L, dt, j):
    """Affine velocity after a step: exact in isotropic flow, and its skew part keeps angular momentum.

    sym(L (I + dt L)^-1) grows in compression without bound, also where nothing flows together, and with it the energy.
    It may regain what it lost while matter was dilated: |sym C| max(J, 1)^(1/3) never grows; where it would, sym(L)
    takes its place.

    Args:
        L: velocity gradient [1/s].
        dt: time step [s].
        j: det F - 1 before the step [-].
    """
    C, J = symmetric(L @ (identity() + dt * L).inverse()), 1.0 + j
    dilation = ti.max(J * (1.0 + determinant_increment(dt * L)), 1.0) / ti.max(J, 1.0)
    after, before = ti.cast(norm_squared(C), ti.f64), ti.cast(norm_squared(symmetric(L)), ti.f64)
    if not dilation**2 * after**3 <= (1.0 + ROUNDING) * before**3:  # sixth powers: single precision has no room
        C = symmetric(L) / ti.max(dilation, 1.0) ** (1.0 / 3.0)
    return C + 0.5 * (L - L.transpose())
