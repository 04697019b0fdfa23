"""Blocks of given particles, built on the device and read back."""

from dataclasses import dataclass

import numpy as np

from engine.mpm.block_coordinates import UNBOUNDED, Period
from engine.mpm.blocks import Blocks
from engine.mpm.stencil import Stencil
from engine.mpm.tiles import Tiles
from engine.state.particles import Particles
from tests.helpers.device import Array


@dataclass(frozen=True)
class Layout:
    """Blocks and tiles, and the particles in their order.

    Attributes:
        origin: block coordinates, shape [block_count, 3].
        first: range of each block in `order`, shape [block_count + 1].
        order: particles by block; ballistic ones come last, shape [particle_count].
        owner: block of those that have one.
        source: for every tile the eight blocks whose copies hold it, or -1; shape [tile_count, 8].
        body: velocity field of every tile, shape [tile_count].
        site: range of the tiles of every site, one for each velocity field there; shape [site_count + 1].
    """

    origin: Array
    first: Array
    order: Array
    owner: Array
    source: Array
    body: Array
    site: Array


class Builder:
    """Builds the blocks of up to 1,024 particles, with the same kernels for any number."""

    def __init__(self, period: Period = UNBOUNDED) -> None:
        self.particles = Particles(1024)
        self.blocks = Blocks(self.particles, 1.0, period)
        self.tiles, self.stencil = Tiles(self.blocks), Stencil(self.particles, 1.0, 1024)

    def place(self, x: Array, body: Array, dx: float) -> bool:
        """Put particles at x [m]; returns whether all are in range."""
        count = len(x)
        self.particles.count, self.blocks.dx[None] = 1024, dx
        padded = {"x": np.zeros((1024, 3)), "body": np.full(1024, 1024)}
        padded["x"][:count], padded["body"][:count] = x, body
        self.particles.index.from_numpy(np.arange(1024, dtype=np.int32))
        self.particles.write(padded)
        self.particles.count = count
        return self.blocks.find()

    def build(self, x: Array, body: Array | None = None, dx: float = 1.0) -> Layout:
        """Blocks of particles at x [m], of one body unless given."""
        assert self.place(x, np.zeros(len(x)) if body is None else body, dx)
        blocks, alone = self.blocks.sort()
        self.blocks.write(self.stencil, blocks, alone)
        self.tiles.write(self.stencil)
        of, shared = self.stencil, len(x) - alone
        site = of.site.to_numpy()[: of.site_count[None] + 1]
        return Layout(
            origin=of.origin.to_numpy()[:blocks],
            first=of.first.to_numpy()[: blocks + 1],
            order=self.particles.index.to_numpy()[: len(x)],
            owner=of.owner.to_numpy()[:shared],
            source=of.source.to_numpy()[: site[-1]],
            body=of.body.to_numpy()[: site[-1]],
            site=site,
        )
