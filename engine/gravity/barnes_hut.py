"""Gravity through a tree (engine/physics.md, section 7; Barnes & Hut 1986).

A node's true bounding box decides whether its multipole is accepted, so any distribution of particles is allowed.
"""

import taichi as ti

from engine.device.backend import TASK, on_gpu, vec3
from engine.device.fields import allocate, capacity
from engine.gravity.multipoles import Multipoles
from engine.state.particles import Particles

BATCH = 64
"""Accepted nodes that a group of targets collects before their field is summed."""


@ti.data_oriented
class BarnesHut(Multipoles):
    """Tree walk: each group of targets accepts a node's multipole if the opening criterion holds, else opens the node.

    The particles of a leaf accept the same nodes. On the CPU one thread walks for all of them and collects what it
    accepts: so the sums of a row of targets stay in registers. On a GPU every particle has a thread, and those of a
    leaf take the same path. Arguments as `Multipoles`.
    """

    def __init__(self, particles: Particles, radius: float, opening: float) -> None:
        super().__init__(particles, radius, opening)
        self.by_leaf = not on_gpu()
        self.batch = BATCH if self.by_leaf else 1
        walks = 1 << self.depth if self.by_leaf else self.room << self.depth
        self.acting = allocate(ti.i32, capacity(walks * self.batch))

    def solve(self, potential: bool) -> None:
        """Build the tree, then walk it for every group of targets; argument as `SelfGravity.solve`."""
        self.build()
        self.walk_all(1 << self.depth, self.size, self.room, potential)

    @ti.kernel
    def walk_all(self, leaves: ti.i32, size: ti.i32, room: ti.i32, potential: ti.template()):
        """Compute the acceleration or the potential of every particle."""
        if ti.static(self.by_leaf):
            for i in range(leaves * TASK):
                if i % TASK == 0:
                    leaf = i // TASK
                    lower, upper = self.lower[leaves + leaf], self.upper[leaves + leaf]
                    self.walk(leaf * room, room // self.lanes, lower, upper, leaves, size, room, potential)
        else:
            for p in range(leaves * room):
                lower, upper = self.lower[leaves + p // room], self.upper[leaves + p // room]
                self.walk(p, 1, lower, upper, leaves, size, room, potential)

    @ti.func
    def walk(self, first, rows, lower, upper, leaves, size, room, potential: ti.template()):
        """Sum over the whole tree for some rows of targets.

        Args:
            first: slot of the first target.
            rows: number of rows.
            lower, upper: corners of a box around the targets.
            leaves, size, room: number of leaves, particles and slots of each, see `Multipoles`.
            potential: whether potentials are summed, else accelerations.
        """
        for row in range(rows):
            self.reset(first + row * self.lanes, potential)
        begin = first // (rows * self.lanes) * self.batch
        end, node = begin, 1
        while node > 0:
            if self.is_far(node, lower, upper):
                self.acting[end] = node
                end += 1
                node = following(node)
            elif node >= leaves:
                source = (node - leaves) * room
                for row in range(rows):
                    self.add_balls(source, source + size, first + row * self.lanes, potential)
                node = following(node)
            else:
                node = 2 * node
            if end == begin + self.batch or node == 0:
                for row in range(rows):
                    self.add_nodes(self.acting, begin, end, first + row * self.lanes, potential)
                end = begin

    @ti.func
    def is_far(self, node, lower, upper):
        """Return whether the multipole of a node is accepted for all targets in a box: the opening criterion."""
        c = self.centre[node]
        centre = vec3(c[0], c[1], c[2])
        gap = ti.max(ti.max(lower - centre, centre - upper), 0.0)
        return gap.norm_sqr() > self.nearest[node] ** 2


@ti.func
def following(node):
    """Return the next node of the walk after a node and all below it; 0 after the last."""
    n = node
    while n & 1 == 1:
        n >>= 1
    if n > 0:
        n += 1
    return n
