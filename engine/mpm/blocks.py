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
        body: velocity field of every tile, shape [tile_count].
        site: range of the tiles of every site, one for each velocity field there; shape [site_count + 1].
    """

    origin: Integers
    first: Integers
    order: Integers
    source: Integers
    body: Integers
    site: Integers


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


def build_blocks(block: Integers, body: Integers, period: Period = UNBOUNDED) -> Blocks:
    """Blocks, order and overlaps from the block of each particle; every velocity field has blocks of its own.

    Args:
        block: block coordinates, shape [particle_count, 3].
        body: velocity field of each particle, shape [particle_count].
        period: blocks after which space repeats along each axis; 0 is unbounded.
    """
    sites, site, particles = np.unique(_key(block), return_inverse=True, return_counts=True)
    ballistic = ((particles == 1) & (_neighbour_count(sites, period) == 1))[site]
    fields = int(body.max(initial=0)) + 1
    order = np.argsort(np.where(ballistic, len(sites) * fields, site * fields + body), kind="stable").astype(np.int32)
    keys, counts = np.unique((site * fields + body)[~ballistic], return_counts=True)
    first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    origin, owner = _coordinates(sites[keys // fields]), (keys % fields).astype(np.int32)
    return Blocks(origin, first, order, *_tiles(origin, owner, period))


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


def _tiles(origin: Integers, body: Integers, period: Period) -> tuple[Integers, Integers, Integers]:
    """The eight blocks over each tile that any block touches, its velocity field, and the tiles of each site."""
    fields = int(body.max(initial=0)) + 1
    touched = _key(_folded(origin[:, None, :] + CORNERS, period))
    sites = np.unique(touched)
    site, field = np.divmod(np.unique(_find(sites, touched) * fields + body[:, None]), fields)
    owners = _key(_folded(_coordinates(sites)[site][:, None, :] - CORNERS, period))
    occupied = np.unique(_key(origin))
    rank = _find(occupied, owners)
    source = _find(_find(occupied, _key(origin)) * fields + body, rank * fields + field[:, None])
    first = np.searchsorted(site, np.arange(len(sites) + 1))
    return source.astype(np.int32), field.astype(np.int32), first.astype(np.int32)


def _find(keys: Integers, wanted: Integers) -> Integers:
    """Index in ascending keys of each wanted one, or -1."""
    index = np.searchsorted(keys, wanted)
    found = np.isin(wanted, keys)
    return np.where(found, index, -1)
