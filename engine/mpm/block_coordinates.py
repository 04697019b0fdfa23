"""Coordinates of blocks of the unbounded grid, and keys that sort as they do.

A block has BLOCK_EDGE^3 cells. Along a periodic axis space repeats after a whole number of blocks.
"""

import taichi as ti

from engine.constants import BLOCK_EDGE

HALF_RANGE = 1 << 20
"""Blocks per axis on either side of the origin."""

BORDER = 3
"""Blocks within the range that particles do not enter: they reach nodes beyond their own block."""

BITS = 21
"""Bits of a key that one coordinate takes."""

Period = tuple[int, int, int]
UNBOUNDED: Period = (0, 0, 0)

place = ti.types.vector(3, ti.i32)


@ti.func
def is_in_range(x, dx):
    """Return whether block coordinates reach a position x [m] on a grid of spacing dx [m]; false where it is NaN."""
    result = True
    for axis in ti.static(range(3)):
        result = result and ti.abs(x[axis] / (BLOCK_EDGE * dx)) < HALF_RANGE - BORDER
    return result


@ti.func
def block_at(x, dx):
    """Return the coordinates of the block that owns a particle at x [m] on a grid of spacing dx [m]."""
    return ti.floor((x / dx - 0.5) / BLOCK_EDGE, ti.i32)


@ti.func
def folded(block, period: ti.template()):
    """Return the coordinates of a block in the first period of each periodic axis."""
    result = block
    for axis in ti.static(range(3)):
        if ti.static(period[axis] > 0):
            result[axis] = block[axis] - block[axis] // period[axis] * period[axis]
    return result


@ti.func
def key_of(block):
    """Return the key of a block."""
    shifted = ti.cast(block + HALF_RANGE, ti.i64)
    return (shifted[0] << (2 * BITS)) | (shifted[1] << BITS) | shifted[2]


@ti.func
def block_of(key):
    """Return the coordinates of the block that has a key."""
    mask = (1 << BITS) - 1
    return ti.cast(ti.Vector([key >> (2 * BITS), (key >> BITS) & mask, key & mask]), ti.i32) - HALF_RANGE


@ti.func
def corner_of(corner):
    """Return the coordinates, 0 or 1, of one of the eight corners of a cube."""
    return place(corner >> 2, (corner >> 1) & 1, corner & 1)
