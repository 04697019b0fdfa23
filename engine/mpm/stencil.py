"""The nodes of every particle: where they lie in memory, their weights, and the sums over them.

Each block of particles has its own copy of the nodes that it reaches (engine/mpm/tiles.py), so on the CPU no two
threads ever add to the same number, and on a GPU every node is summed by one: results do not depend on their count.
"""

import taichi as ti

from engine.constants import BLOCK_EDGE
from engine.device.backend import EPSILON, Real, mat3, on_gpu, vec3, vec4
from engine.device.fields import allocate, capacity
from engine.mpm.block_coordinates import corner_of
from engine.mpm.spline import SECOND_MOMENT, WIDTH, first_moments, spline_weights, sum_of_squares
from engine.state.particles import Particles

EDGE_BITS = BLOCK_EDGE.bit_length() - 1
"""Bits that count the nodes along an edge of a tile."""
TILE = BLOCK_EDGE**3
"""Nodes of a tile."""
MARGIN = 1
"""Cells that a particle may move out of its block before blocks are built anew."""
SPAN = 2 * BLOCK_EDGE
"""Nodes along an edge of a block's copy."""
COPY = SPAN**3
"""Nodes of a block's copy."""

ROUND_OFF_MASS = 50.0 * EPSILON
"""Ratio to a particle's mass below which the mass of others on its nodes is round-off.

The smaller of both masses at a node bounds the momentum they can exchange there, so that none is lost with them.
"""

SURELY_SHARED = 1e-3
"""Ratio of the mean mass of others on a particle's nodes to its own above which the nodes are surely shared."""


@ti.data_oriented
class Stencil:
    """Blocks of the grid, with scatter to their nodes and gather from them.

    Args:
        particles: state of the particles.
        dx: grid spacing [m].
        blocks: number of blocks to make room for.

    Attributes:
        by_node: whether a thread sums one node over the particles of its block, as on a GPU, or all nodes of a block.
        origin, first, body_of_block: coordinates of every block, its first particle, and its velocity field.
        source: of every tile, the eight blocks whose copies hold it, or -1.
        body: velocity field of every tile.
        site: first tile of every site; those of all velocity fields there follow.
        nodes: every node of every copy; momentum [kg m/s] and mass [kg] after the scatter, velocity [m/s] and mass
            after the grid update.
        shared_count: particles whose block, or one beside it, contains others; they come first in memory.
        ballistic_count: particles with no other in their block nor in any block beside it.
    """

    def __init__(self, particles: Particles, dx: float, blocks: int) -> None:
        self.particles, self.by_node, self.capacity = particles, on_gpu(), capacity(blocks)
        self.dx = allocate(ti.f64)
        self.dx[None] = dx
        self.block_count, self.site_count = allocate(ti.i32), allocate(ti.i32)
        self.shared_count, self.ballistic_count = allocate(ti.i32), allocate(ti.i32)
        self.owner = allocate(ti.i32, particles.x.shape)
        self.origin = allocate(ti.types.vector(3, ti.i32), self.capacity)
        self.first = allocate(ti.i32, self.capacity + 1)
        self.body_of_block = allocate(ti.i32, self.capacity)
        self.source = allocate(ti.i32, (8 * self.capacity, 8))
        self.body, self.site = allocate(ti.i32, 8 * self.capacity), allocate(ti.i32, 8 * self.capacity + 1)
        self.nodes = allocate(vec4, self.capacity * COPY)

    def set_counts(self, blocks: int, shared: int, ballistic: int) -> None:
        """Set the numbers of blocks, of the particles in them, and of others."""
        self.block_count[None], self.shared_count[None], self.ballistic_count[None] = blocks, shared, ballistic

    @ti.func
    def lowest_node(self, p):
        """Return the grid coordinates of the lowest node of particle p."""
        return ti.floor(self.particles.x[p] / self.dx[None] - 0.5, ti.i32)

    @ti.func
    def locate(self, p, b):
        """Return the index of the lowest node of particle p in the copy of block b, and its distance in cells."""
        local, f = self.place(p, b)
        return b * COPY + in_copy(local), f

    @ti.func
    def place(self, p, b):
        """Return the coordinates of the lowest node of particle p in the copy of block b, and its distance in cells."""
        base = self.lowest_node(p)
        first = BLOCK_EDGE * self.origin[b] - MARGIN
        # a particle faster than any time step allows stays within the copy: its weights still sum to one
        local = ti.min(ti.max(base - first, 0), SPAN - WIDTH)
        base = first + local
        f = ti.cast(self.particles.x[p] / self.dx[None] - ti.cast(base, ti.f64), Real)
        return local, f

    @ti.func
    def scatter(self, n, f, mass, momentum, affine):
        """Add w (momentum + affine r) and w mass to the nodes of a particle.

        The value at node (i, j, k) is that of the lowest node + i, j and k times the columns of `affine`, so the sum is
        unrolled axis by axis.

        Args:
            n, f: lowest node, and distance of the particle from it in cells.
            mass: [kg].
            momentum: [kg m/s], shape [3].
            affine: change of momentum per cell [kg m/s], shape [3, 3].
        """
        w = spline_weights(f)
        lowest = vec4(momentum - affine @ f, mass)
        by_x, by_y, by_z = vec4(affine[:, 0], 0.0), vec4(affine[:, 1], 0.0), vec4(affine[:, 2], 0.0)
        for i in range(WIDTH):
            for j in ti.static(range(WIDTH)):
                weight = w[0, i] * w[1, j]
                row = weight * (lowest + i * by_x + j * by_y)
                row_by_z = weight * by_z
                for k in ti.static(range(WIDTH)):
                    m = n + (i * SPAN + j) * SPAN + k
                    self.nodes[m] = self.nodes[m] + w[2, k] * (row + k * row_by_z)  # += would be atomic

    @ti.func
    def seen_from(self, p, n):
        """Return the coordinates of node n above the lowest node of particle p of its block, and its distance [cells].

        The particle gives to the node if all coordinates are from 0 to WIDTH - 1.
        """
        local, f = self.place(p, n // COPY)
        above = in_copy_coordinates(n % COPY) - local
        return above, f

    @ti.func
    def gather(self, n, f, w):
        """Return sum w v [m/s], sum w m [kg] and sum w v r^T/(m2 dx) [1/s]: mean velocity, mass, and velocity gradient.

        Args:
            n, f: lowest node of the particle, and distance from it in cells.
            w: weights of its nodes.
        """
        w_z, d_z = w[2, :], first_moments(w[2, :], f[2])
        d_x, d_y = first_moments(w[0, :], f[0]), first_moments(w[1, :], f[1])
        mean, by_x, by_y, by_z = vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0)
        for i in range(WIDTH):
            plane, plane_by_y, plane_by_z = vec4(0.0), vec4(0.0), vec4(0.0)
            for j in ti.static(range(WIDTH)):
                m = n + (i * SPAN + j) * SPAN
                first, second, third = self.nodes[m], self.nodes[m + 1], self.nodes[m + 2]
                row = w_z[0] * first + w_z[1] * second + w_z[2] * third
                row_by_z = d_z[0] * first + d_z[1] * second + d_z[2] * third
                plane += w[1, j] * row
                plane_by_y += d_y[j] * row
                plane_by_z += w[1, j] * row_by_z
            mean += w[0, i] * plane
            by_x += d_x[i] * plane
            by_y += w[0, i] * plane_by_y
            by_z += w[0, i] * plane_by_z
        per_dx = 1.0 / (SECOND_MOMENT * ti.cast(self.dx[None], Real))
        L = per_dx * mat3(by_x[0], by_y[0], by_z[0], by_x[1], by_y[1], by_z[1], by_x[2], by_y[2], by_z[2])
        return vec3(mean[0], mean[1], mean[2]), mean[3], L

    @ti.func
    def is_ballistic(self, p, n, w, mean_mass):
        """Return whether particle p shares no node with another.

        Args:
            p: index of the particle.
            n: its lowest node.
            w: weights of its nodes.
            mean_mass: mean mass of its nodes [kg].
        """
        mass, result = self.particles.mass[p], False
        # what others have on average costs nothing to know, and settles it for almost all particles
        if mean_mass - mass * sum_of_squares(w) <= SURELY_SHARED * mass:
            result = self.shared_mass(mass, w, n) <= ROUND_OFF_MASS * mass
        return result

    @ti.func
    def shared_mass(self, mass, w, n):
        """Return the sum over the nodes of a particle of the smaller of its own and all others' mass [kg]."""
        shared = ti.cast(0.0, Real)
        for i in range(WIDTH):
            for j in range(WIDTH):
                for k in ti.static(range(WIDTH)):
                    own = w[0, i] * w[1, j] * w[2, k] * mass
                    shared += ti.min(own, self.nodes[n + (i * SPAN + j) * SPAN + k][3] - own)
        return shared

    @ti.func
    def sum_of_copies(self, tile, node):
        """Return the sum over all copies of a node of a tile: momentum [kg m/s] and mass [kg]."""
        total = vec4(0.0)
        for corner in range(8):
            b = self.source[tile, corner]
            if b >= 0:
                total += self.nodes[b * COPY + corner_offset(corner) + in_copy(node)]
        return total

    @ti.func
    def set_copies(self, tile, node, value):
        """Write a value into all copies of a node of a tile."""
        for corner in range(8):
            b = self.source[tile, corner]
            if b >= 0:
                self.nodes[b * COPY + corner_offset(corner) + in_copy(node)] = value

    @ti.func
    def node_position(self, tile, node):
        """Return the position of a node of a tile [m]."""
        first = ti.Vector([0, 0, 0])
        for corner in range(8):
            b = self.source[tile, corner]
            if b >= 0:
                first = BLOCK_EDGE * (self.origin[b] + corner_of(corner)) - MARGIN
        return self.dx[None] * ti.cast(first + node, ti.f64)


@ti.func
def within_margin(x, block):
    """Return whether the copy of a block contains all nodes of a particle, also half a cell further on.

    Within a step a particle moves by at most half a cell before blocks can be built anew.

    Args:
        x: position of the particle in cells.
        block: coordinates of the block.
    """
    local = x - ti.cast(BLOCK_EDGE * block - MARGIN, ti.f64)
    return local.min() >= 1.0 and local.max() < SPAN - WIDTH + 1.0


@ti.func
def node_in_tile(n):
    """Return the coordinates of node n within its tile."""
    return ti.Vector(
        [(n >> (2 * EDGE_BITS)) & (BLOCK_EDGE - 1), (n >> EDGE_BITS) & (BLOCK_EDGE - 1), n & (BLOCK_EDGE - 1)]
    )


@ti.func
def in_copy_coordinates(n):
    """Return the coordinates of node n of a block's copy within it."""
    return ti.Vector([n // (SPAN * SPAN), n // SPAN % SPAN, n % SPAN])


@ti.func
def corner_offset(corner):
    """Return the index of the first node of a tile in the copy of the block at one of its corners."""
    return in_copy(BLOCK_EDGE * corner_of(corner))


@ti.func
def in_copy(node):
    """Return the index in a block's copy of the node at these coordinates within it."""
    return (node[0] * SPAN + node[1]) * SPAN + node[2]
