"""Gravity through a tree of multipoles (engine/physics.md, section 7; Barnes & Hut 1986).

The tree is a complete binary one: node 1 is the root, node n has the children 2n and 2n + 1, and each child holds half
of its parent's particles, cut at the median along the longest side. So no node is empty, none refers to another, and
the leaves follow one another in memory. A node's true bounding box decides whether it may act as a whole, so any
distribution of particles will do.
"""

import math
from typing import Any

import numpy as np
import taichi as ti

from engine.backend import TASK, Real, mat3, on_gpu, vec3, vec4, vec6
from engine.gravity import Places, SelfGravity, Vectors
from engine.tensors import identity, pack, unpack

LEAF = 16
"""Most particles in a leaf."""


@ti.data_oriented
class Tree(SelfGravity):
    """Multipoles up to the quadrupole about each node's centre of mass.

    Args:
        particles: state of the particles.
        radius: radius of the ball that stands for one particle [m].
        opening: a node acts as a whole on targets that are farther from its centre of mass than its reach (the distance
            to the farthest corner of its box) over `opening`; the error of its pull is then of the order opening^3.
    """

    def __init__(self, particles: Any, radius: float, opening: float) -> None:
        self.depth, self.size = _shape(particles.count)
        super().__init__(particles, radius, self.size << self.depth)
        shape = max(1024, 2 << self.depth)
        self.opening = ti.field(Real, ())
        self.opening[None] = opening
        self.lower, self.upper = vec3.field(shape=shape), vec3.field(shape=shape)
        self.centre, self.quadrupole = vec4.field(shape=shape), vec6.field(shape=shape)
        self.reach = ti.field(Real, shape)
        self.by_leaf = not on_gpu()

    def arrange(self, x: Vectors) -> Places:
        """Particles by leaf, found by halving all nodes of a level at once; -1 fills the leaves up to one size."""
        rows = np.full((1, self.size << self.depth), -1)
        rows[0, : self.count] = np.arange(self.count)
        for _ in range(self.depth):
            points = x[np.maximum(rows, 0)]
            longest = np.argmax(np.ptp(points, axis=1), axis=1)
            coordinate = np.take_along_axis(points, longest[:, None, None], axis=2)[:, :, 0]
            halves = np.argpartition(coordinate, rows.shape[1] // 2, axis=1)
            rows = np.take_along_axis(rows, halves, axis=1).reshape(2 * len(rows), -1)
        return rows.ravel()

    def solve(self) -> None:
        """Build the tree from its leaves up, then let every group of targets walk it."""
        leaves = 1 << self.depth
        self.gather_leaves(leaves, self.size)
        for level in reversed(range(self.depth)):
            self.merge_level(1 << level)
        self.walk_all(leaves, self.size)

    @ti.kernel
    def gather_leaves(self, leaves: ti.i32, size: ti.i32):
        """Box, centre of mass and quadrupole of every leaf."""
        for leaf in range(leaves):
            first = leaf * size
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

    @ti.kernel
    def walk_all(self, leaves: ti.i32, size: ti.i32):
        """Acceleration and potential of every particle; on the CPU the particles of a leaf walk together."""
        if ti.static(self.by_leaf):
            for t in range(leaves * TASK):
                if t % TASK == 0:
                    leaf = t // TASK
                    first, node = leaf * size, leaves + leaf
                    self.walk(first, first + size, self.lower[node], self.upper[node], leaves, size)
        else:
            for p in range(leaves * size):
                self.walk(p, p + 1, self.point(p), self.point(p), leaves, size)

    @ti.func
    def walk(self, first, last, lower, upper, leaves, size):
        """Add the pull of the whole tree to targets inside one box."""
        self.clear(first, last)
        node = 1
        while node > 0:
            if self.is_far(node, lower, upper):
                self.add_multipole(node, first, last)
                node = following(node)
            elif node >= leaves:
                for q in range((node - leaves) * size, (node - leaves + 1) * size):
                    self.add_ball(q, first, last)
                node = following(node)
            else:
                node = 2 * node

    @ti.func
    def is_far(self, node, lower, upper):
        """Whether a node may act as a whole on targets in a box: far for its size, and no ball of it is touched."""
        c = self.centre[node]
        centre = vec3(c[0], c[1], c[2])
        distance = ti.max(ti.max(lower - centre, centre - upper), 0.0).norm()
        reach = self.reach[node]
        return reach < self.opening[None] * distance and distance - reach > self.radius[None]

    @ti.func
    def add_multipole(self, node, first, last):
        """Add the pull of a node's mass and quadrupole to a range of targets."""
        c, Q = self.centre[node], unpack(self.quadrupole[node])
        for p in range(first, last):
            d = vec3(self.x[p] - c[0], self.y[p] - c[1], self.z[p] - c[2])
            inverse = 1.0 / d.norm()
            square = inverse * inverse
            fifth = square * square * inverse
            Qd = Q @ d
            dQd = d.dot(Qd)
            radial = -(c[3] * inverse * square + 2.5 * dQd * fifth * square)
            self.ax[p] = self.ax[p] + radial * d[0] + fifth * Qd[0]
            self.ay[p] = self.ay[p] + radial * d[1] + fifth * Qd[1]
            self.az[p] = self.az[p] + radial * d[2] + fifth * Qd[2]
            self.potential[p] = self.potential[p] - c[3] * inverse - 0.5 * dQd * fifth

    @ti.func
    def point(self, p):
        """Position of a particle [m]."""
        return vec3(self.x[p], self.y[p], self.z[p])

    @ti.func
    def set_node(self, node, lower, upper, centre, mu, Q):
        """Store a node."""
        self.lower[node], self.upper[node] = lower, upper
        self.centre[node] = vec4(centre[0], centre[1], centre[2], mu)
        self.quadrupole[node] = pack(Q)
        self.reach[node] = ti.max(centre - lower, upper - centre).norm()


def _shape(count: int) -> tuple[int, int]:
    """Levels below the root, and particles in a leaf."""
    depth = max(0, math.ceil(math.log2(count / LEAF)))
    return depth, -(-count >> depth)


@ti.func
def quadrupole_of(mu, d):
    """Traceless quadrupole of a point mass at d."""
    return mu * (3.0 * d.outer_product(d) - d.norm_sqr() * identity())


@ti.func
def following(node):
    """The node to visit after a node and all below it; 0 after the last."""
    n = node
    while n & 1 == 1:
        n >>= 1
    if n > 0:
        n += 1
    return n
