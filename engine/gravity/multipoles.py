"""Multipoles of groups of particles: their moments, and the pull of these (engine/physics.md, section 7).

The groups are the nodes of a complete binary tree: node 1 is the root, node n has the children 2n and 2n + 1, and each
child holds half of its parent's particles, cut at the median along the longest side. So no node is empty, none refers
to another, and the leaves follow one another in memory.
"""

import math
from typing import Any

import numpy as np
import taichi as ti

from engine.device.backend import Real, capacity, mat3, vec3, vec4, vec6
from engine.device.tensors import identity, pack, unpack
from engine.gravity.median_partition import halve
from engine.gravity.self_gravity import LANES, Places, SelfGravity, Vectors

LEAF = 24
"""Most particles in a leaf: three rows."""


@ti.data_oriented
class Multipoles(SelfGravity):
    """Box, mass and quadrupole about the centre of mass of every node; what a walk over them has in common.

    Args:
        particles: state of the particles.
        radius: radius of the ball that stands for one particle [m].
        opening: a node acts as a whole on targets that are farther from its centre of mass than its reach (the distance
            to the farthest corner of its box) over `opening`; the error of its pull is then of the order opening^3.
    """

    def __init__(self, particles: Any, radius: float, opening: float) -> None:
        self.depth, self.size = _shape(particles.count)
        self.room = -(-self.size // LANES) * LANES
        super().__init__(particles, radius, self.room << self.depth)
        self.opening = ti.field(Real, ())
        self.opening[None] = opening
        shape = capacity(2 << self.depth)
        self.lower, self.upper = vec3.field(shape=shape), vec3.field(shape=shape)
        self.centre, self.quadrupole = vec4.field(shape=shape), vec6.field(shape=shape)
        self.nearest = ti.field(Real, shape)

    def arrange(self, x: Vectors) -> Places:
        """Particles by leaf, each leaf filled up to whole rows."""
        leaves = halve(x, self.depth, self.size)
        nobody = np.minimum(leaves[:, :1], ~leaves[:, :1])
        return np.concatenate([leaves, nobody.repeat(self.room - self.size, axis=1)], axis=1).ravel()

    def build(self) -> None:
        """All nodes from the leaves up."""
        self.gather_leaves(1 << self.depth, self.size, self.room)
        for level in reversed(range(self.depth)):
            self.merge_level(1 << level)

    @ti.kernel
    def gather_leaves(self, leaves: ti.i32, size: ti.i32, room: ti.i32):
        """Box, centre of mass and quadrupole of every leaf."""
        for leaf in range(leaves):
            first = leaf * room
            lower, upper = self.point(first), self.point(first)
            weight, mu = vec3(0.0), ti.cast(0.0, Real)
            for p in range(first, first + size):
                lower, upper = ti.min(lower, self.point(p)), ti.max(upper, self.point(p))
                weight += self.mu[p] * (self.point(p) - self.point(first))
                mu += self.mu[p]
            centre = self.point(first)
            if mu > 0.0:
                centre += weight / mu
            Q = mat3(0.0)
            for p in range(first, first + size):
                Q += quadrupole_of(self.mu[p], self.point(p) - centre)
            self.set_node(leaves + leaf, lower, upper, centre, mu, Q)

    @ti.kernel
    def merge_level(self, nodes: ti.i32):
        """All nodes of one level from their children."""
        for n in range(nodes, 2 * nodes):
            a, b = self.centre[2 * n], self.centre[2 * n + 1]
            ca, cb = vec3(a[0], a[1], a[2]), vec3(b[0], b[1], b[2])
            centre = ca
            if b[3] > 0.0:
                centre += (b[3] / (a[3] + b[3])) * (cb - ca)
            Q = unpack(self.quadrupole[2 * n]) + unpack(self.quadrupole[2 * n + 1])
            Q += quadrupole_of(a[3], ca - centre) + quadrupole_of(b[3], cb - centre)
            lower = ti.min(self.lower[2 * n], self.lower[2 * n + 1])
            upper = ti.max(self.upper[2 * n], self.upper[2 * n + 1])
            self.set_node(n, lower, upper, centre, a[3] + b[3], Q)

    @ti.func
    def set_node(self, node, lower, upper, centre, mu, Q):
        """Store a node; no target nearer than `nearest` to its centre may take it as a whole, or touch a ball of it."""
        self.lower[node], self.upper[node] = lower, upper
        self.centre[node] = vec4(centre[0], centre[1], centre[2], mu)
        self.quadrupole[node] = pack(Q)
        reach = ti.max(centre - lower, upper - centre).norm()
        self.nearest[node] = ti.max(reach / self.opening[None], reach + self.radius[None])

    @ti.func
    def add_nodes(self, acting: ti.template(), begin, end, t, potential: ti.template()):
        """Add the pull or the potential of the nodes in `acting`, from `begin` to `end`, to a row of targets."""
        if ti.static(potential):
            self.add_node_potential(acting, begin, end, t)
        else:
            self.add_node_pull(acting, begin, end, t)

    @ti.func
    def add_node_pull(self, acting: ti.template(), begin, end, t):
        """With Q the quadrupole and d from the centre: (Q d - (mu d^2 + 5/2 d.Q d / d^2) d) / d^5."""
        X, Y, Z = self.load(self.x, t), self.load(self.y, t), self.load(self.z, t)
        ax, ay, az = self.load(self.ax, t), self.load(self.ay, t), self.load(self.az, t)
        for i in range(begin, end):
            c, Q = self.centre[acting[i]], self.quadrupole[acting[i]]
            dx, dy, dz = X - c[0], Y - c[1], Z - c[2]
            Qx, Qy, Qz = row_product(Q, dx, dy, dz)
            square = dx * dx + dy * dy + dz * dz
            inverse = 1.0 / square
            fifth = inverse * inverse * ti.sqrt(inverse)
            radial = c[3] * square + 2.5 * inverse * (dx * Qx + dy * Qy + dz * Qz)
            ax += fifth * (Qx - radial * dx)
            ay += fifth * (Qy - radial * dy)
            az += fifth * (Qz - radial * dz)
        self.store(self.ax, t, ax)
        self.store(self.ay, t, ay)
        self.store(self.az, t, az)

    @ti.func
    def add_node_potential(self, acting: ti.template(), begin, end, t):
        """-mu / d - d.Q d / 2 d^5."""
        X, Y, Z = self.load(self.x, t), self.load(self.y, t), self.load(self.z, t)
        potential = self.load(self.potential, t)
        for i in range(begin, end):
            c, Q = self.centre[acting[i]], self.quadrupole[acting[i]]
            dx, dy, dz = X - c[0], Y - c[1], Z - c[2]
            Qx, Qy, Qz = row_product(Q, dx, dy, dz)
            inverse = 1.0 / (dx * dx + dy * dy + dz * dz)
            both = 0.5 * (dx * Qx + dy * Qy + dz * Qz) * inverse * inverse
            potential -= ti.sqrt(inverse) * (c[3] + both)
        self.store(self.potential, t, potential)

    @ti.func
    def point(self, p):
        """Position of a particle [m]."""
        return vec3(self.x[p], self.y[p], self.z[p])


def _shape(count: int) -> tuple[int, int]:
    """Levels below the root, and particles in a leaf."""
    depth = max(0, math.ceil(math.log2(count / LEAF)))
    return depth, -(-count >> depth)


@ti.func
def row_product(Q, dx, dy, dz):
    """Components of Q d for a packed tensor and a row of vectors d."""
    return Q[0] * dx + Q[5] * dy + Q[4] * dz, Q[5] * dx + Q[1] * dy + Q[3] * dz, Q[4] * dx + Q[3] * dy + Q[2] * dz


@ti.func
def quadrupole_of(mu, d):
    """Traceless quadrupole of a point mass at d."""
    return mu * (3.0 * d.outer_product(d) - d.norm_sqr() * identity())
