"""Blocks of particles and their overlaps, whatever the particles."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.device import backend
from tests.helpers.blocks import Builder, Layout
from tests.helpers.device import Array

DX = 3.0
STENCIL = np.stack(np.meshgrid(*[range(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
SHIFTS = np.stack(np.meshgrid(*[(-1, 0, 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)

Node = tuple[int, ...]


@st.composite
def clouds(draw: st.DrawFn) -> Array:
    """Positions [m] of a few clumps, dense or sparse, near the origin or far from it."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32)))
    clumps = draw(st.integers(1, 4))
    sizes = [draw(st.integers(1, 12)) for _ in range(clumps)]
    extent = draw(st.sampled_from([0.0, 1.0, 10.0, 40.0])) * DX
    spread = draw(st.sampled_from([0.0, 10.0, 100.0])) * DX
    centre = draw(st.sampled_from([0.0, -1e3, 1e6])) * DX
    parts = [centre + spread * generator.normal(size=3) + extent * generator.normal(size=(n, 3)) for n in sizes]
    return np.concatenate(parts)


def bodies(seed: int, x: Array, count: int = 3) -> Array:
    """Index of the body of every particle, at random."""
    return np.random.default_rng(seed).integers(0, count, len(x))


@pytest.fixture(scope="module")
def builder() -> Builder:
    backend.start(threads=1)
    return Builder()


def built(builder: Builder, x: Array, seed: int) -> tuple[Layout, Array]:
    """Blocks of particles that belong to bodies at random, and these bodies."""
    body = bodies(seed, x)
    return builder.build(x, body, DX), body


def lowest_nodes(x: Array) -> Array:
    """Lowest of the three nodes per axis whose quadratic splines reach a particle."""
    return np.floor(x / DX - 0.5).astype(int)


def touched(base: Array) -> set[Node]:
    return {tuple(node) for node in base + STENCIL}


def owners(blocks: Layout, count: int) -> list[int | None]:
    """Index of the block that holds each particle, `None` if it is alone."""
    owner: list[int | None] = [None] * count
    for b, (begin, end) in enumerate(zip(blocks.first[:-1], blocks.first[1:], strict=True)):
        for p in blocks.order[begin:end]:
            owner[p] = b
    return owner


@given(clouds(), st.integers(0, 2**32))
def test_every_particle_is_in_exactly_one_block_of_its_body_or_alone(builder, x, seed):
    blocks, body = built(builder, x, seed)
    assert np.array_equal(np.sort(blocks.order), np.arange(len(x)))
    owned: dict[int, int] = {}
    for p, owner in enumerate(owners(blocks, len(x))):
        if owner is not None:
            assert np.array_equal(blocks.origin[owner], lowest_nodes(x)[p] // 4)
            assert owned.setdefault(owner, body[p]) == body[p]
    sites = {(*blocks.origin[owner], body) for owner, body in owned.items()}
    assert len(sites) == len(owned) == len(blocks.origin)
    assert np.array_equal(blocks.owner, np.repeat(np.arange(len(blocks.origin)), np.diff(blocks.first)))


@given(clouds())
def test_particles_keep_their_order_within_a_block(builder, x):
    blocks = builder.build(x, dx=DX)
    for begin, end in zip(blocks.first[:-1], blocks.first[1:], strict=True):
        assert end > begin
        assert (np.diff(blocks.order[begin:end]) > 0).all()


@given(clouds(), st.integers(0, 2**32))
def test_a_particle_alone_shares_no_node_even_after_all_have_moved_one_cell(builder, x, seed):
    (blocks, _), base = built(builder, x, seed), lowest_nodes(x)
    for p in blocks.order[blocks.first[-1] :]:
        # nodes base to base + 2, both moved by one cell towards each other
        apart = np.abs(np.delete(base, p, axis=0) - base[p]).max(axis=1)
        assert (apart - 2 > 2).all()


@given(clouds(), st.integers(0, 2**32))
def test_all_copies_of_a_node_are_summed_wherever_particles_move_by_a_cell(builder, x, seed):
    blocks, body = built(builder, x, seed)
    base = lowest_nodes(x) + np.random.default_rng(seed).choice(SHIFTS, len(x))
    writers: dict[tuple[Node, int], set[int]] = {}
    for p, owner in enumerate(owners(blocks, len(x))):
        if owner is not None:
            first = 4 * blocks.origin[owner] - 1
            assert (base[p] >= first).all() and (base[p] + 2 < first + 8).all()
            for node in touched(base[p]):
                writers.setdefault((node, int(body[p])), set()).add(owner)
    summed = tile_sources(blocks)
    for (node, of), writing in writers.items():
        assert writing <= summed[tile_of(node), of]


@given(clouds(), st.integers(0, 2**32))
def test_the_tiles_of_all_bodies_at_one_place_stand_together(builder, x, seed):
    blocks, _ = built(builder, x, seed)
    tiles = list(tile_sources(blocks))
    found = [
        [tiles[t] for t in range(first, last)] for first, last in zip(blocks.site[:-1], blocks.site[1:], strict=True)
    ]
    assert [tile for site in found for tile in site] == tiles
    assert all(len({tile for tile, _ in site}) == 1 for site in found)
    assert len({site[0][0] for site in found}) == len(found)


def tile_of(node: Node) -> Node:
    """Copies begin at node 4 b - 1 of block b, and tiles with them."""
    return tuple((coordinate + 1) // 4 for coordinate in node)


def tile_sources(blocks: Layout) -> dict[tuple[Node, int], set[int]]:
    """Blocks that every tile sums over; the one at corner (a, b, c) of the list lies at the tile minus (a, b, c)."""
    result: dict[tuple[Node, int], set[int]] = {}
    for sources, body in zip(blocks.source, blocks.body, strict=True):
        corners = {
            tuple(int(c) for c in blocks.origin[b] + [corner >> 2, corner >> 1 & 1, corner & 1])
            for corner, b in enumerate(sources)
            if b >= 0
        }
        assert len(corners) == 1, "all blocks of a tile hold the same nodes"
        result[corners.pop(), int(body)] = {int(b) for b in sources if b >= 0}
    assert len(result) == len(blocks.source), "every tile is summed once"
    return result


def test_one_particle_is_alone(builder):
    blocks = builder.build(np.array([[-7.0, 0.1, 1e5]]))
    assert len(blocks.origin) == len(blocks.source) == 0
    assert np.array_equal(blocks.first, [0]) and np.array_equal(blocks.order, [0])


def test_coincident_particles_share_a_block(builder):
    blocks = builder.build(np.zeros((2, 3)))
    assert np.array_equal(blocks.first, [0, 2])
    assert np.array_equal(np.unique(blocks.source), [-1, 0])


def test_blocks_do_not_depend_on_a_shift_by_whole_blocks(builder):
    x = 20.0 * np.random.default_rng(1).normal(size=(300, 3))
    here, there = builder.build(x, dx=DX), builder.build(x - 4 * DX * 1000, dx=DX)
    assert np.array_equal(here.order, there.order) and np.array_equal(here.first, there.first)
    assert np.array_equal(here.source, there.source) and np.array_equal(here.origin, there.origin + 1000)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_clump_1e8_m_away_is_still_in_range(builder, sign):
    x = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, sign * 1e8], [10.0, 0.0, sign * 1e8]])
    blocks = builder.build(x, dx=100.0)
    assert np.array_equal(blocks.order, [1, 2, 0]) and np.array_equal(blocks.first, [0, 2])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e8, -1e300])
def test_a_position_beyond_the_range_is_told(builder, bad):
    x = np.zeros((3, 3))
    assert builder.place(x, np.zeros(3), 1.0)
    x[1, 2] = bad
    assert not builder.place(x, np.zeros(3), 1.0)


@pytest.mark.parametrize("block", [2**20 - 4, -(2**20) + 4])
def test_blocks_at_the_edge_of_the_range_have_all_their_neighbours(builder, block):
    x = np.full((2, 3), 4.0 * block + 2.0)
    blocks = builder.build(x)
    assert np.array_equal(blocks.origin, np.full((1, 3), block))
    assert len(tile_sources(blocks)) == 8


PERIODS = (1, 2, 3, 5)


@pytest.fixture(scope="module")
def periodic(builder: Builder) -> dict[int, Builder]:
    """Builders for space that repeats along x after some blocks."""
    return {period: Builder((period, 0, 0)) for period in PERIODS}


@given(st.integers(0, 2**32), st.sampled_from(PERIODS))
def test_a_periodic_axis_has_the_blocks_and_tiles_of_the_space_it_repeats(periodic, builder, seed, period):
    """Beside the middle one of three equal periods there is what lies beside the only one."""
    generator, length = np.random.default_rng(seed), 4.0 * period * np.array([1.0, 0.0, 0.0])
    x = generator.uniform(size=(12, 3)) * [4.0 * period, 8.0, 8.0] + 0.5
    one = periodic[period].build(x + generator.integers(-2, 3, size=(12, 1)) * length)
    three = builder.build(np.concatenate([x - length, x, x + length]))
    inside = (three.origin[:, 0] >= 0) & (three.origin[:, 0] < period)
    assert np.array_equal(one.origin, three.origin[inside])
    folded = {(tile[0] % period, *tile[1:]): places for tile, places in places_below(one, period).items()}
    assert folded == {t: places for t, places in places_below(three, period).items() if 0 <= t[0] < period}


def places_below(blocks: Layout, period: int) -> dict[Node, dict[int, Node]]:
    """Where the block at each corner of every tile lies, in the first period along x."""
    result = {}
    for source in blocks.source:
        corners = np.flatnonzero(source >= 0)
        low = blocks.origin[source[corners]]
        tile = low[0] + [corners[0] >> 2, corners[0] >> 1 & 1, corners[0] & 1]
        places = low % [period, 1000, 1000]
        result[tuple(map(int, tile))] = {int(c): tuple(map(int, at)) for c, at in zip(corners, places, strict=True)}
    return result
