"""Order of particles in a kd-tree cut at medians, on a GPU.

Leaves are those of engine/gravity/median_partition.py, unless two particles have the same coordinate at a cut."""

import taichi as ti

from engine.device.backend import place3
from engine.device.fields import allocate, capacity
from engine.device.merge_sort import MergeSort


@ti.data_oriented
class DevicePartition:
    """Particles sorted into leaves: every node is cut at the median along the longest side of its box.

    All nodes of a level are cut at once, each by a sort of its particles. Copies of particles fill the leaves up to
    their size.

    Args:
        count: number of particles.
        levels: levels below the root; there are 2^levels leaves.
        size: particles in a leaf, at least count / 2^levels.

    Attributes:
        order: its values are the particles leaf by leaf; ~p is a copy of particle p.
        lower, upper: corners of the box of every node of a level [m].
    """

    def __init__(self, count: int, levels: int, size: int) -> None:
        self.count, self.levels, self.size = count, levels, size
        self.order = MergeSort(capacity(size << levels))
        self.lower, self.upper = (allocate(place3, capacity(1 << levels)) for _ in range(2))

    def partition(self, x: ti.Field) -> None:
        """Sort particles at positions x [m] into leaves."""
        self.list_particles(self.order.side, self.count, self.size << self.levels)
        for level in range(self.levels):
            self.write_keys(x, self.order.side, level, self.levels, self.size)
            self.order.sort(self.size << self.levels, self.size, self.size << (self.levels - level))

    def write(self, particle_of: ti.Field, room: int) -> None:
        """Write the particles leaf by leaf, or ~p for a copy of particle p.

        Args:
            particle_of: receives them.
            room: places of a leaf; those beyond its size have copies of its first particle.
        """
        self.write_leaves(particle_of, self.order.side, room << self.levels, self.size, room)

    @ti.kernel
    def write_leaves(self, particle_of: ti.template(), side: ti.i32, places: ti.i32, size: ti.i32, room: ti.i32):
        """Set the particle of every place."""
        for i in range(places):
            first = self.order.value[side, i // room * size]
            particle_of[i] = ti.min(first, ~first)
            if i % room < size:
                particle_of[i] = self.order.value[side, i // room * size + i % room]

    @ti.kernel
    def list_particles(self, side: ti.i32, count: ti.i32, entries: ti.i32):
        """List all particles, and copies up to a number of entries."""
        for i in range(entries):
            self.order.value[side, i] = i
            if i >= count:
                self.order.value[side, i] = ~((i - count) % count)

    @ti.kernel
    def write_keys(self, x: ti.template(), side: ti.i32, level: ti.i32, levels: ti.i32, size: ti.i32):
        """Find the box of every node of a level, and take coordinates along its longest side as keys."""
        for node in range(1 << level):
            self.lower[node], self.upper[node] = place3(ti.math.inf), place3(-ti.math.inf)
        for leaf in range(1 << levels):
            lower, upper = place3(ti.math.inf), place3(-ti.math.inf)
            for i in range(leaf * size, (leaf + 1) * size):
                lower, upper = ti.min(lower, x[self.particle(side, i)]), ti.max(upper, x[self.particle(side, i)])
            node = leaf >> (levels - level)
            ti.atomic_min(self.lower[node], lower)
            ti.atomic_max(self.upper[node], upper)
        for i in range(size << levels):
            node = (i // size) >> (levels - level)
            sides, at = self.upper[node] - self.lower[node], x[self.particle(side, i)]
            coordinate = at[0]
            if sides[1] > sides[0] and sides[1] >= sides[2]:
                coordinate = at[1]
            elif sides[2] > sides[0]:
                coordinate = at[2]
            # a copy comes after its particle, as on the host
            self.order.key[side, i] = ordered(coordinate) + ti.cast(self.order.value[side, i] < 0, ti.i64)

    @ti.func
    def particle(self, side, i):
        """Return the particle of an entry, or that of which it is a copy."""
        value = self.order.value[side, i]
        return ti.max(value, ~value)


@ti.func
def ordered(value):
    """Return an integer that sorts as a double does."""
    bits = ti.bit_cast(value, ti.i64)
    if bits < 0:
        bits = ~bits + (ti.cast(-1, ti.i64) << 63)
    return bits
