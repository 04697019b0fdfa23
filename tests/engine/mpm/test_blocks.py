import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.mpm.blocks import Blocks, block_of, build_blocks, out_of_range
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


def one_body(x: Array, dx: float = DX) -> Blocks:
    return build_blocks(block_of(x, dx), np.zeros(len(x), dtype=int))


def lowest_nodes(x: Array) -> Array:
    """Lowest of the three nodes per axis whose quadratic splines reach a particle."""
    return np.floor(x / DX - 0.5).astype(int)


def touched(base: Array) -> set[Node]:
    return {tuple(node) for node in base + STENCIL}


def owners(blocks: Blocks, count: int) -> list[int | None]:
    """Index of the block that holds each particle, `None` if it is alone."""
    owner: list[int | None] = [None] * count
    for b, (begin, end) in enumerate(zip(blocks.first[:-1], blocks.first[1:], strict=True)):
        for p in blocks.order[begin:end]:
            owner[p] = b
    return owner


@given(clouds(), st.integers(0, 2**32))
def test_every_particle_is_in_exactly_one_block_of_its_body_or_alone(x, seed):
    block, body = block_of(x, DX), bodies(seed, x)
    blocks = build_blocks(block, body)
    assert np.array_equal(np.sort(blocks.order), np.arange(len(x)))
    owned: dict[int, int] = {}
    for p, owner in enumerate(owners(blocks, len(x))):
        assert np.array_equal(block[p], lowest_nodes(x)[p] // 4)
        if owner is not None:
            assert np.array_equal(blocks.origin[owner], block[p])
            assert owned.setdefault(owner, body[p]) == body[p]
    sites = {(*blocks.origin[owner], body) for owner, body in owned.items()}
    assert len(sites) == len(owned) == len(blocks.origin)


@given(clouds())
def test_particles_keep_their_order_within_a_block(x):
    blocks = one_body(x)
    for begin, end in zip(blocks.first[:-1], blocks.first[1:], strict=True):
        assert end > begin
        assert (np.diff(blocks.order[begin:end]) > 0).all()


@given(clouds(), st.integers(0, 2**32))
def test_a_particle_alone_shares_no_node_even_after_all_have_moved_one_cell(x, seed):
    blocks, base = build_blocks(block_of(x, DX), bodies(seed, x)), lowest_nodes(x)
    for p in blocks.order[blocks.first[-1] :]:
        # nodes base to base + 2, both moved by one cell towards each other
        apart = np.abs(np.delete(base, p, axis=0) - base[p]).max(axis=1)
        assert (apart - 2 > 2).all()


@given(clouds(), st.integers(0, 2**32))
def test_all_copies_of_a_node_are_summed_wherever_particles_move_by_a_cell(x, seed):
    body = bodies(seed, x)
    blocks = build_blocks(block_of(x, DX), body)
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
def test_the_tiles_of_all_bodies_at_one_place_stand_together(x, seed):
    blocks = build_blocks(block_of(x, DX), bodies(seed, x))
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


def tile_sources(blocks: Blocks) -> dict[tuple[Node, int], set[int]]:
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


def test_one_particle_is_alone():
    blocks = one_body(np.array([[-7.0, 0.1, 1e5]]))
    assert len(blocks.origin) == len(blocks.source) == 0
    assert np.array_equal(blocks.first, [0]) and np.array_equal(blocks.order, [0])


def test_coincident_particles_share_a_block():
    blocks = one_body(np.zeros((2, 3)))
    assert np.array_equal(blocks.first, [0, 2])
    assert np.array_equal(np.unique(blocks.source), [-1, 0])


def test_blocks_do_not_depend_on_a_shift_by_whole_blocks():
    x = 20.0 * np.random.default_rng(1).normal(size=(300, 3))
    here, there = one_body(x), one_body(x - 4 * DX * 1000)
    assert np.array_equal(here.order, there.order) and np.array_equal(here.first, there.first)
    assert np.array_equal(here.source, there.source) and np.array_equal(here.origin, there.origin + 1000)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_clump_1e8_m_away_is_still_in_range(sign):
    x = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, sign * 1e8], [10.0, 0.0, sign * 1e8]])
    blocks = one_body(x, 100.0)
    assert np.array_equal(blocks.order, [1, 2, 0]) and np.array_equal(blocks.first, [0, 2])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e8, -1e300])
def test_a_position_beyond_the_range_is_told(bad):
    x = np.zeros((3, 3))
    x[1, 2] = bad
    assert np.array_equal(out_of_range(x, 1.0), [False, True, False])


@pytest.mark.parametrize("block", [2**20 - 4, -(2**20) + 4])
def test_blocks_at_the_edge_of_the_range_have_all_their_neighbours(block):
    x = np.full((2, 3), 4.0 * block + 2.0)
    blocks = one_body(x, 1.0)
    assert np.array_equal(blocks.origin, np.full((1, 3), block))
    assert len(tile_sources(blocks)) == 8
