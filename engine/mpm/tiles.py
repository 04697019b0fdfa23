"""Which blocks share nodes: the tiles that the copies of neighbouring blocks have in common.

The 8x8x8 nodes of a block's copy are eight tiles of 4x4x4, at the block's place and at those above it. The nodes of a
tile lie in the copies of up to eight blocks of a velocity field. The tiles of all fields at a place stand together.
"""

import taichi as ti

from engine.device.prefix_sum import PrefixSum, pair
from engine.mpm.block_coordinates import block_of, corner_of
from engine.mpm.blocks import Blocks
from engine.mpm.stencil import Stencil

NONE = 2**31 - 1
"""Above all velocity fields."""


@ti.data_oriented
class Tiles:
    """Tiles over the blocks of particles.

    Every place of blocks lists the tiles at its eight corners for which it is the first of the eight places below.

    Args:
        blocks: of the particles.
    """

    def __init__(self, blocks: Blocks) -> None:
        self.blocks = blocks
        self.sums: PrefixSum = blocks.sums

    def write(self, stencil: Stencil) -> None:
        """Write the tiles over the blocks of a stencil."""
        places = int(self.blocks.place_count[None])
        self.count_tiles(stencil, places)
        self.sums.run(places)
        self.write_tiles(stencil, places)

    @ti.kernel
    def count_tiles(self, stencil: ti.template(), places: ti.i32):
        """Count the sites and the tiles that every place lists."""
        for i in range(places):
            count = pair(0)
            for corner in range(8):
                tile = block_of(self.blocks.key[i]) + corner_of(corner)
                if self.lists(i, tile, corner):
                    count[0] += 1
                    field = self.next_field(stencil, tile, -1)
                    while field >= 0:
                        count[1] += 1
                        field = self.next_field(stencil, tile, field)
            self.sums.before[i] = count

    @ti.kernel
    def write_tiles(self, stencil: ti.template(), places: ti.i32):
        """Write every site, its tiles, and the blocks over each."""
        for i in range(places):
            before = self.sums.before[i]
            for corner in range(8):
                tile = block_of(self.blocks.key[i]) + corner_of(corner)
                if self.lists(i, tile, corner):
                    stencil.site[before[0]] = before[1]
                    before[0] += 1
                    field = self.next_field(stencil, tile, -1)
                    while field >= 0:
                        self.write_tile(stencil, before[1], tile, field)
                        before[1] += 1
                        field = self.next_field(stencil, tile, field)
        stencil.site_count[None] = self.sums.before[places][0]
        stencil.site[self.sums.before[places][0]] = self.sums.before[places][1]

    @ti.func
    def write_tile(self, stencil: ti.template(), index, tile, field):
        """Write the velocity field of a tile, and the block of that field below each of its corners, or -1."""
        stencil.body[index] = field
        for corner in range(8):
            stencil.source[index, corner] = -1
            i = self.place_below(tile, corner)
            if i >= 0:
                for b in range(self.blocks.first_block[i], self.blocks.first_block[i + 1]):
                    if stencil.body_of_block[b] == field:
                        stencil.source[index, corner] = b

    @ti.func
    def lists(self, i, tile, corner):
        """Return whether place i has blocks, and no lower corner of the tile at its `corner` has any below."""
        result = self.blocks.first_block[i + 1] > self.blocks.first_block[i]
        for lower in range(corner):
            if result:
                result = self.place_below(tile, lower) < 0
        return result

    @ti.func
    def next_field(self, stencil: ti.template(), tile, field):
        """Return the lowest velocity field above `field` among the blocks of a tile, or -1."""
        lowest = NONE
        for corner in range(8):
            i = self.place_below(tile, corner)
            if i >= 0:
                for b in range(self.blocks.first_block[i], self.blocks.first_block[i + 1]):
                    if stencil.body_of_block[b] > field:
                        lowest = ti.min(lowest, stencil.body_of_block[b])
        if lowest == NONE:
            lowest = -1
        return lowest

    @ti.func
    def place_below(self, tile, corner):
        """Return the place of blocks whose copies have the tile at one of their corners, or -1."""
        i = self.blocks.find_place(tile - corner_of(corner))
        if i >= 0 and self.blocks.first_block[ti.max(i, 0) + 1] == self.blocks.first_block[ti.max(i, 0)]:
            i = -1
        return i
