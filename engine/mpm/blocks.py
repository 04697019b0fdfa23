"""Which blocks of the unbounded grid hold particles, and in what order particles lie in memory.

A block owns the particles of one velocity field whose lowest node lies in its 4x4x4 cells. All of this is built anew
when a particle has used up the margin of its block, on the device, by sorting.
"""

import taichi as ti

from engine.constants import BLOCK_EDGE
from engine.device.fields import allocate, capacity
from engine.device.merge_sort import MergeSort
from engine.device.permutation import Permutation
from engine.device.prefix_sum import PrefixSum, pair
from engine.mpm.block_coordinates import (
    UNBOUNDED,
    Period,
    block_at,
    block_of,
    folded,
    is_in_range,
    key_of,
    place,
)
from engine.mpm.stencil import Stencil
from engine.state.particles import Particles


@ti.data_oriented
class Blocks:
    """Blocks of particles.

    A place is the coordinates of a block at which there are particles; every velocity field there has a block of its
    own. A particle alone at its place, with none at any place beside it, has no block: it flies freely.

    Args:
        particles: state of the particles, with all fields that the scene needs.
        dx: grid spacing [m].
        period: blocks after which space repeats along each axis; 0 is unbounded.
        separates: whether every body has a velocity field of its own.

    Attributes:
        place_count: number of places.
        key: of every place, ascending.
        first_particle: of every place, in the order of the keys; one more ends the last.
        first_block: of every place; one more ends the last.
        is_alone: whether a place has one particle, and none beside it.
        place_of: place of every particle, in the order of the keys.
        slot: index on the device of every particle, by its number in the scene.
        far: 1 if a particle was beyond the range of coordinates.
    """

    def __init__(self, particles: Particles, dx: float, period: Period = UNBOUNDED, separates: bool = True) -> None:
        self.particles, self.period, self.separates = particles, period, separates
        self.is_periodic = any(period)
        self.dx = allocate(ti.f64)
        self.dx[None] = dx
        size = capacity(particles.count)
        self.sorted, self.sums = MergeSort(size), PrefixSum(size)
        self.permutation = Permutation(particles.fields, size)
        self.place_of, self.is_alone, self.slot = (allocate(ti.i32, size) for _ in range(3))
        self.key = allocate(ti.i64, size)
        self.first_particle, self.first_block = (allocate(ti.i32, size + 1) for _ in range(2))
        self.place_count, self.far = allocate(ti.i32), allocate(ti.i32)

    def find(self) -> bool:
        """Set the block of every particle, and move particles by whole periods; return whether all are in range."""
        self.far[None] = 0
        self.find_blocks(self.particles.count)
        return not self.far[None]

    def sort(self) -> tuple[int, int]:
        """Sort the particles into blocks; return the numbers of blocks and of particles without one."""
        count = self.particles.count
        self.fill_keys(self.sorted.side, count)
        self.sorted.sort(count)
        self.mark_places(self.sorted.side, count)
        self.sums.run(count)
        self.list_places(self.sorted.side, count)
        self.mark_blocks(self.sorted.side, count)
        self.sums.run(count)
        blocks, alone = self.sums.before[count]
        return int(blocks), int(alone)

    def write(self, stencil: Stencil, blocks: int, alone: int) -> None:
        """Write the blocks, and move the particles into their order.

        Args:
            stencil: has room for them.
            blocks, alone: as `sort` returned them.
        """
        shared = self.particles.count - alone
        stencil.set_counts(blocks, shared, alone)
        self.write_blocks(stencil, self.sorted.side, self.particles.count, blocks, shared)
        self.permutation.apply(self.particles.count)

    @ti.kernel
    def find_blocks(self, count: ti.i32):
        """Set the block of every particle, and move it by whole periods into the first one of each periodic axis."""
        for p in range(count):
            x, dx = self.particles.x[p], self.dx[None]
            if is_in_range(x, dx):
                block = block_at(x, dx)
                if ti.static(self.is_periodic):
                    periods = ti.cast(block - folded(block, self.period), ti.f64)
                    self.particles.x[p] = x - periods * (BLOCK_EDGE * dx)
                self.particles.origin[p] = folded(block, self.period)
            else:
                self.far[None] = 1

    @ti.kernel
    def fill_keys(self, side: ti.i32, count: ti.i32):
        """List the particles body by body, as they are numbered, with the keys of their blocks."""
        for p in range(count):
            self.slot[self.particles.index[p]] = p
        for i in range(count):
            number = self.particles.listed[i]
            self.sorted.put(side, i, key_of(self.particles.origin[self.slot[number]]), number)

    @ti.func
    def begins_place(self, side, k):
        """Return whether the sorted particle k is the first of its place."""
        return k == 0 or self.sorted.key[side, k] != self.sorted.key[side, ti.max(k - 1, 0)]

    @ti.func
    def begins_block(self, side, k):
        """Return whether the sorted particle k is the first of its velocity field at its place."""
        result = self.begins_place(side, k)
        if ti.static(self.separates):
            result = result or self.body(side, k) != self.body(side, ti.max(k - 1, 0))
        return result

    @ti.func
    def body(self, side, k):
        """Return the velocity field of the sorted particle k."""
        result = 0
        if ti.static(self.separates):
            result = self.particles.body[self.slot[self.sorted.value[side, k]]]
        return result

    @ti.kernel
    def mark_places(self, side: ti.i32, count: ti.i32):
        """Count the places."""
        for k in range(count):
            self.sums.before[k] = pair(ti.cast(self.begins_place(side, k), ti.i32), 0)

    @ti.kernel
    def list_places(self, side: ti.i32, count: ti.i32):
        """Write the list of places."""
        for k in range(count):
            i = self.sums.before[k + 1][0] - 1
            self.place_of[k] = i
            if self.begins_place(side, k):
                self.key[i], self.first_particle[i] = self.sorted.key[side, k], k
            if k == count - 1:
                self.place_count[None], self.first_particle[i + 1] = i + 1, count

    @ti.kernel
    def mark_blocks(self, side: ti.i32, count: ti.i32):
        """Find which places have one particle and none beside them; count the blocks of the others, and those."""
        for i in range(self.place_count[None]):
            single = self.first_particle[i + 1] - self.first_particle[i] == 1
            self.is_alone[i] = 0
            if single and not self.has_neighbour(i):
                self.is_alone[i] = 1
        for k in range(count):
            alone = self.is_alone[self.place_of[k]]
            self.sums.before[k] = pair(ti.cast(self.begins_block(side, k), ti.i32) * (1 - alone), alone)

    @ti.kernel
    def write_blocks(self, stencil: ti.template(), side: ti.i32, count: ti.i32, blocks: ti.i32, shared: ti.i32):
        """Write the blocks, and where every particle comes from; those without a block come last."""
        for k in range(count):
            i, before = self.place_of[k], self.sums.before[k]
            to = k - before[1]
            if self.is_alone[i]:
                to = shared + before[1]
            else:
                stencil.owner[to] = self.sums.before[k + 1][0] - 1
                if self.begins_block(side, k):
                    stencil.first[before[0]], stencil.origin[before[0]] = to, block_of(self.key[i])
                    stencil.body_of_block[before[0]] = self.body(side, k)
            if self.begins_place(side, k):
                self.first_block[i] = before[0]
            self.permutation.source[to] = self.slot[self.sorted.value[side, k]]
        stencil.first[blocks] = shared
        self.first_block[self.place_count[None]] = blocks

    @ti.func
    def has_neighbour(self, i):
        """Return whether there are particles at a place beside place i."""
        found = False
        for n in range(27):
            step = place(n // 9 - 1, n // 3 % 3 - 1, n % 3 - 1)
            beside = self.find_place(block_of(self.key[i]) + step)
            found = found or (beside >= 0 and n != 13)
        return found

    @ti.func
    def find_place(self, block):
        """Return the index of the place with the coordinates of a block, or -1; bisection."""
        key = key_of(folded(block, self.period))
        low, high = 0, self.place_count[None]
        while low < high:
            half = (low + high) // 2
            if self.key[half] < key:
                low = half + 1
            else:
                high = half
        if low == self.place_count[None] or self.key[ti.min(low, self.place_count[None] - 1)] != key:
            low = -1
        return low
