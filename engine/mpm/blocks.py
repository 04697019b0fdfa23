"""Which blocks of the unbounded grid hold particles, and which blocks share nodes.

A block owns the particles whose lowest node lies in its 4x4x4 cells, and a private copy of the 8x8x8 nodes they may
touch until one of them has moved a whole cell beyond the block. Copies of neighbouring blocks overlap: the nodes of
every 4x4x4 `tile` lie in the copies of up to eight blocks. All of this is rebuilt on the host, only when a particle
has used up that margin.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.constants import BLOCK_EDGE

HALF_RANGE = 1 << 20
"""Blocks per axis on either side of the origin."""

Integers = NDArray[np.integer]
Period = tuple[int, int, int]
UNBOUNDED = (0, 0, 0)

CORNERS = np.array(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij")).reshape(3, 8).T
NEIGHBOURS = np.array(np.meshgrid([-1, 0, 1], [-1, 0, 1], [-1, 0, 1], indexing="ij")).reshape(3, 27).T


@dataclass(frozen=True)
class Blocks:
    """Occupied blocks and their overlaps.

    Attributes:
        origin: block coordinates, shape [block_count, 3].
        first: range of each block in `order`, shape [block_count + 1].
        order: particles by block, then by index; ballistic ones come last, shape [particle_count].
        source: for every tile the eight blocks whose copies hold it, or -1; shape [tile_count, 8].
    """

    origin: Integers
    first: Integers
    order: Integers
    source: Integers


def out_of_range(x: NDArray[np.floating], dx: float) -> NDArray[np.bool_]:
    """Which particles block coordinates cannot reach, or are nowhere; arguments as `block_of`."""
    return np.asarray(~(np.abs(x / (BLOCK_EDGE * dx)) < HALF_RANGE - 3).all(axis=1))


def block_of(x: NDArray[np.floating], dx: float) -> Integers:
    """Coordinates of the block that owns each particle.

    Args:
        x: positions [m], none of them out of range, shape [particle_count, 3].
        dx: grid spacing [m].
    """
    return np.floor((x / dx - 0.5) / BLOCK_EDGE).astype(np.int32)


def wrap(x: NDArray[np.float64], block: Integers, dx: float, period: Period) -> tuple[NDArray[np.float64], Integers]:
    """Positions [m] and blocks moved by whole periods into the first one of each periodic axis."""
    turns = np.where(np.array(period) > 0, block // np.maximum(period, 1), 0)
    return x - turns * period * (BLOCK_EDGE * dx), (block - turns * period).astype(np.int32)


def build_blocks(block: Integers, period: Period = UNBOUNDED) -> Blocks:
    """Blocks, order and overlaps from the block of each particle.

    Args:
        block: block coordinates, shape [particle_count, 3].
        period: blocks after which space repeats along each axis; 0 is unbounded.
    """
    keys, inverse, counts = np.unique(_key(block), return_inverse=True, return_counts=True)
    ballistic = (counts == 1) & (_neighbour_count(keys, period) == 1)
    rank = np.where(ballistic, len(keys), np.arange(len(keys)))[inverse]
    order = np.argsort(rank, kind="stable").astype(np.int32)
    shared = keys[~ballistic]
    first = np.concatenate([[0], np.cumsum(counts[~ballistic])]).astype(np.int32)
    return Blocks(_coordinates(shared), first, order, _sources(shared, period))


def _folded(block: Integers, period: Period) -> Integers:
    """Block coordinates in the first period of each periodic axis."""
    return np.where(np.array(period) > 0, block % np.maximum(period, 1), block)


def _key(block: Integers) -> Integers:
    shifted = block.astype(np.int64) + HALF_RANGE
    return np.asarray((shifted[..., 0] << 42) | (shifted[..., 1] << 21) | shifted[..., 2])


def _coordinates(keys: Integers) -> Integers:
    mask = (1 << 21) - 1
    axes = [keys >> 42, (keys >> 21) & mask, keys & mask]
    return (np.stack(axes, axis=-1) - HALF_RANGE).astype(np.int32)


def _neighbour_count(keys: Integers, period: Period) -> Integers:
    """Number of occupied blocks among the 27 around each block, itself included."""
    around = _key(_folded(_coordinates(keys)[:, None, :] + NEIGHBOURS, period))
    return np.asarray(np.isin(around, keys).sum(axis=1))


def _sources(keys: Integers, period: Period) -> Integers:
    """The eight blocks over each tile that any block touches."""
    tiles = _coordinates(np.unique(_key(_folded(_coordinates(keys)[:, None, :] + CORNERS, period))))
    owners = _key(_folded(tiles[:, None, :] - CORNERS, period))
    index = np.searchsorted(keys, owners)
    found = np.isin(owners, keys)
    return np.where(found, index, -1).astype(np.int32)
