import numpy as np
import pytest

from engine.gravity.median_partition import median_order
from tests.helpers.device import Array


def cloud(count: int) -> Array:
    return np.random.default_rng(count).normal(size=(count, 3)) * [1.0, 5.0, 2.0]


@pytest.mark.parametrize(("count", "levels", "size"), [(1, 0, 1), (7, 0, 7), (7, 2, 2), (96, 3, 12), (1000, 6, 16)])
def test_every_particle_has_one_place_and_copies_have_the_rest(count, levels, size):
    order = median_order(cloud(count), levels, size)
    assert order.shape == (1 << levels, size)
    assert sorted(order[order >= 0]) == list(range(count))
    assert np.unique(order).size == order.size, "no particle is copied twice while there are others"


@pytest.mark.parametrize(("count", "levels", "size"), [(64, 4, 4), (100, 3, 16), (1000, 6, 16)])
def test_every_node_is_cut_into_equal_halves_at_its_median_along_its_longest_side(count, levels, size):
    """On each level, copies included; of a node, no particle of one half lies beyond one of the other."""
    x, order = cloud(count), median_order(cloud(count), levels, size)
    particle = np.where(order < 0, ~order, order)
    for level in range(levels):
        for lower, upper in particle.reshape(1 << level, 2, -1):
            node = x[np.concatenate([lower, upper])]
            axis = np.argmax(np.ptp(node, axis=0))
            assert len(lower) == len(upper) == (size << levels) >> (level + 1)
            assert x[lower, axis].max() <= np.median(node[:, axis]) <= x[upper, axis].min()


def test_the_order_in_which_particles_are_given_moves_none_to_another_leaf():
    x = cloud(512)
    shuffled = np.random.default_rng(1).permutation(512)
    leaves, again = median_order(x, 5, 16), shuffled[median_order(x[shuffled], 5, 16)]
    assert np.array_equal(np.sort(leaves, axis=1), np.sort(again, axis=1))


def test_particles_in_one_place_are_halved_too():
    assert sorted(median_order(np.ones((32, 3)), 3, 4).ravel()) == list(range(32))
