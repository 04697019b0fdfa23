"""Monopole and quadrupole of groups of particles, and their field (engine/physics.md, section 7).

The groups are the nodes of a complete binary tree: node 1 is the root, node n has the children 2n and 2n + 1, and each
child holds half of its parent's particles, cut at the median along the longest side. So no node is empty, none refers
to another, and the leaves follow one another in memory.
"""

import math

import numpy as np
import taichi as ti

from engine.device.backend import Real, mat3, on_gpu, vec3, vec4, vec6
from engine.device.fields import allocate, capacity, overwrite
from engine.device.tensors import identity, pack, unpack
from engine.gravity.device_partition import DevicePartition
from engine.gravity.median_partition import median_order
from engine.gravity.self_gravity import LANES, SelfGravity
from engine.state.particles import Particles

LEAF = 24
"""Most particles in a leaf: three rows."""


@ti.data_oriented
class Multipoles(SelfGravity):
    """Bounding box, mass and quadrupole about the centre of mass of every node of the tree.

    Args:
        particles: state of the particles.
        radius: radius of the ball of a particle [m].
        opening: opening angle [-]: the multipole of a node is accepted for targets farther from its centre of mass than
            reach / opening, with the reach from there to the farthest corner of its box. The error is of the order
            opening^3.

    Attributes:
        depth: levels below the root; the tree has 2^depth leaves.
        size: particles in a leaf, copies included.
        room: slots of a leaf, `size` filled up to whole rows.
        leaves: sorts the particles on a GPU; on a CPU the host does.
        lower, upper: corners of the box of every node.
        centre: centre of mass of every node, and its gm as fourth component.
        quadrupole: traceless quadrupole of every node, packed.
        nearest: least distance from the centre of mass at which the multipole of a node is accepted.
    """

    def __init__(self, particles: Particles, radius: float, opening: float) -> None:
        self.depth, self.size = _shape(particles.count)
        self.room = -(-self.size // LANES) * LANES
        super().__init__(particles, radius, self.room << self.depth)
        self.leaves = DevicePartition(particles.count, self.depth, self.size) if on_gpu() else None
        self.opening = allocate(Real)
        self.opening[None] = opening
        shape = capacity(2 << self.depth)
        self.lower, self.upper = allocate(vec3, shape), allocate(vec3, shape)
        self.centre, self.quadrupole = allocate(vec4, shape), allocate(vec6, shape)
        self.nearest = allocate(Real, shape)

    def arrange(self) -> None:
        """Sort the particles into leaves, each padded to whole rows."""
        if self.leaves:
            self.leaves.partition(self.position)
            self.leaves.write(self.particle_of, self.room)
        else:
            leaves = median_order(self.position.to_numpy()[: self.count], self.depth, self.size)
            padding = np.minimum(leaves[:, :1], ~leaves[:, :1]).repeat(self.room - self.size, axis=1)
            overwrite(self.particle_of, np.concatenate([leaves, padding], axis=1).ravel())

    def build(self) -> None:
        """Compute all nodes, from the leaves up."""
        self.gather_leaves(1 << self.depth, self.size, self.room)
        for level in reversed(range(self.depth)):
            self.merge_level(1 << level)

    @ti.kernel
    def gather_leaves(self, leaves: ti.i32, size: ti.i32, room: ti.i32):
        """Compute box, centre of mass and quadrupole of every leaf."""
        for leaf in range(leaves):
            first = leaf * room
            lower, upper = self.point(first), self.point(first)
            weight, gm = vec3(0.0), ti.cast(0.0, Real)
            for p in range(first, first + size):
                lower, upper = ti.min(lower, self.point(p)), ti.max(upper, self.point(p))
                weight += self.gm[p] * (self.point(p) - self.point(first))
                gm += self.gm[p]
            centre = self.point(first)
            if gm > 0.0:
                centre += weight / gm
            Q = mat3(0.0)
            for p in range(first, first + size):
                Q += quadrupole_of(self.gm[p], self.point(p) - centre)
            self.set_node(leaves + leaf, lower, upper, centre, gm, Q)

    @ti.kernel
    def merge_level(self, nodes: ti.i32):
        """Compute all nodes of one level from their children (parallel-axis theorem)."""
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
    def set_node(self, node, lower, upper, centre, gm, Q):
        """Store a node and the distance at which its multipole is accepted, in the solver's units.

        `nearest` is the larger of reach / opening and reach + radius: beyond the second no target is inside a ball.

        Args:
            node: index of the node.
            lower, upper: corners of its box.
            centre: its centre of mass.
            gm: G_NEWTON times its mass.
            Q: its traceless quadrupole.
        """
        self.lower[node], self.upper[node] = lower, upper
        self.centre[node] = vec4(centre[0], centre[1], centre[2], gm)
        self.quadrupole[node] = pack(Q)
        reach = ti.max(centre - lower, upper - centre).norm()
        self.nearest[node] = ti.max(reach / self.opening[None], reach + self.radius[None])

    @ti.func
    def add_nodes(self, acting: ti.template(), begin, end, t, potential: ti.template()):
        """Add the acceleration or the potential of the nodes acting[begin:end] to a row of targets."""
        if ti.static(potential):
            self.add_node_potential(acting, begin, end, t)
        else:
            self.add_node_pull(acting, begin, end, t)

    @ti.func
    def add_node_pull(self, acting: ti.template(), begin, end, t):
        """Add (Q d - (gm d^2 + 5/2 d.Q d / d^2) d) / d^5, with the quadrupole Q and d from the centre of mass."""
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
        """Add -gm / d - d.Q d / 2 d^5."""
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
        """Return the position in slot p."""
        return vec3(self.x[p], self.y[p], self.z[p])


def _shape(count: int) -> tuple[int, int]:
    """Levels below the root, and particles in a leaf."""
    depth = max(0, math.ceil(math.log2(count / LEAF)))
    return depth, -(-count >> depth)


@ti.func
def row_product(Q, dx, dy, dz):
    """Return the components of Q d for a packed tensor and a row of vectors d."""
    return Q[0] * dx + Q[5] * dy + Q[4] * dz, Q[5] * dx + Q[1] * dy + Q[3] * dz, Q[4] * dx + Q[3] * dy + Q[2] * dz


@ti.func
def quadrupole_of(gm, d):
    """Return the traceless quadrupole gm (3 d d^T - d^2 I) of a point mass at d from the centre."""
    return gm * (3.0 * d.outer_product(d) - d.norm_sqr() * identity())
