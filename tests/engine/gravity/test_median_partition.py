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


def test_a_node_is_cut_at_the_median_along_its_longest_side():
    x = cloud(64)
    for level in range(4):
        nodes = x[median_order(x, 4, 4)].reshape(1 << level, 2, -1, 3)
        for lower, upper in nodes:
            axis = np.argmax(np.ptp(np.concatenate([lower, upper]), axis=0))
            assert lower[:, axis].max() < upper[:, axis].min()


def test_particles_in_one_place_are_halved_too():
    assert sorted(median_order(np.ones((32, 3)), 3, 4).ravel()) == list(range(32))


def test_the_same_particles_have_the_same_order():
    assert np.array_equal(median_order(cloud(500), 5, 16), median_order(cloud(500), 5, 16))
