"""Leaves of the tree, cut on the host and on the device."""

import numpy as np
import pytest
import taichi as ti

from engine.device.backend import place3
from engine.device.fields import allocate, capacity, overwrite
from engine.gravity.device_partition import DevicePartition, ordered
from engine.gravity.median_partition import median_order
from tests.helpers.device import Array

pytestmark = pytest.mark.usefixtures("taichi")


def device_order(x: Array, levels: int, size: int) -> Array:
    """As `median_order`."""
    position, leaves = allocate(place3, capacity(len(x))), DevicePartition(len(x), levels, size)
    overwrite(position, x)
    leaves.partition(position)
    particle_of = allocate(ti.i32, capacity(size << levels))
    leaves.write(particle_of, size)
    return particle_of.to_numpy()[: size << levels].reshape(-1, size)


ways = pytest.mark.parametrize("partition", [median_order, device_order])


def cloud(count: int) -> Array:
    return np.random.default_rng(count).normal(size=(count, 3)) * [1.0, 5.0, 2.0]


@ways
@pytest.mark.parametrize(("count", "levels", "size"), [(1, 0, 1), (7, 0, 7), (7, 2, 2), (96, 3, 12), (1000, 6, 16)])
def test_every_particle_has_one_place_and_copies_have_the_rest(partition, count, levels, size):
    order = partition(cloud(count), levels, size)
    assert order.shape == (1 << levels, size)
    assert sorted(order[order >= 0]) == list(range(count))
    assert np.unique(order).size == order.size, "no particle is copied twice while there are others"


@ways
@pytest.mark.parametrize(("count", "levels", "size"), [(64, 4, 4), (100, 3, 16), (1000, 6, 16)])
def test_every_node_is_cut_into_equal_halves_at_its_median_along_its_longest_side(partition, count, levels, size):
    """On each level, copies included; of a node, no particle of one half lies beyond one of the other."""
    x, order = cloud(count), partition(cloud(count), levels, size)
    particle = np.where(order < 0, ~order, order)
    for level in range(levels):
        for lower, upper in particle.reshape(1 << level, 2, -1):
            node = x[np.concatenate([lower, upper])]
            axis = np.argmax(np.ptp(node, axis=0))
            assert len(lower) == len(upper) == (size << levels) >> (level + 1)
            assert x[lower, axis].max() <= np.median(node[:, axis]) <= x[upper, axis].min()


@ways
def test_the_order_in_which_particles_are_given_moves_none_to_another_leaf(partition):
    x = cloud(512)
    shuffled = np.random.default_rng(1).permutation(512)
    leaves, again = partition(x, 5, 16), shuffled[partition(x[shuffled], 5, 16)]
    assert np.array_equal(np.sort(leaves, axis=1), np.sort(again, axis=1))


@ways
def test_particles_in_one_place_are_halved_too(partition):
    assert sorted(partition(np.ones((32, 3)), 3, 4).ravel()) == list(range(32))


@pytest.mark.parametrize("count", [128 * 24, 3000])
def test_host_and_device_cut_the_same_leaves(count):
    """Copies, which are where their particles are, included."""
    x = cloud(count)
    leaves, again = median_order(x, 7, 24), device_order(x, 7, 24)
    assert np.array_equal(np.sort(leaves, axis=1), np.sort(again, axis=1))


def test_padding_of_a_leaf_is_where_its_first_particle_is():
    position, leaves = allocate(place3, 1024), DevicePartition(96, 3, 12)
    overwrite(position, cloud(96))
    leaves.partition(position)
    particle_of = allocate(ti.i32, 1024)
    leaves.write(particle_of, 16)
    places = particle_of.to_numpy()[:128].reshape(8, 16)
    assert sorted(places[:, :12].ravel()) == list(range(96))
    assert np.array_equal(places[:, 12:], np.tile(~places[:, :1], (1, 4)))


def test_keys_sort_as_positive_and_negative_doubles_do():
    values = [-1e300, -2.0, -1.0, -5e-324, 0.0, 5e-324, 1.0, 1.0 + 2.3e-16, 1e300]
    given, keys = allocate(ti.f64, 9), allocate(ti.i64, 9)
    overwrite(given, np.array(values))

    @ti.kernel
    def write():
        for i in range(9):
            keys[i] = ordered(given[i])

    write()
    assert (np.diff(keys.to_numpy()[:9]) > 0).all()
