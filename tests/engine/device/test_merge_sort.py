"""Sorting and running sums on the device, against NumPy."""

import numpy as np
import pytest

from engine.device.fields import capacity
from engine.device.merge_sort import MergeSort
from engine.device.prefix_sum import CHUNK, PrefixSum
from tests.helpers.device import Array

pytestmark = pytest.mark.usefixtures("taichi")


def sort(keys: Array, **given: int) -> tuple[Array, Array]:
    """The keys in their order, and the index that each had."""
    sorter = MergeSort(capacity(len(keys)))
    for field, values in ((sorter.key, keys), (sorter.value, np.arange(len(keys)))):
        whole = field.to_numpy()
        whole[0, : len(keys)] = values
        field.from_numpy(whole)
    sorter.sort(len(keys), **given)
    return tuple(field.to_numpy()[sorter.side, : len(keys)] for field in (sorter.key, sorter.value))


@pytest.mark.parametrize("count", [1, 2, 31, 32, 33, 64, 65, 1000, 5000])
@pytest.mark.parametrize("spread", [1, 5, 2**62])
def test_entries_are_in_the_order_of_a_stable_sort(count, spread):
    keys = np.random.default_rng(count).integers(-spread, spread, count)
    key, index = sort(keys)
    assert np.array_equal(index, np.argsort(keys, kind="stable")) and np.array_equal(key, keys[index])


@pytest.mark.parametrize("piece", [13, 24])
@pytest.mark.parametrize("pieces", [1, 2, 8])
def test_segments_are_sorted_each_for_itself(piece, pieces):
    segment = piece * pieces
    keys = np.random.default_rng(piece).integers(0, 99, 8 * segment)
    key, index = sort(keys, piece=piece, segment=segment)
    assert np.array_equal(key.reshape(8, -1), np.sort(keys.reshape(8, -1)))
    assert np.array_equal(key, keys[index])


@pytest.mark.parametrize("count", [1, CHUNK - 1, CHUNK, CHUNK + 1, 3000])
def test_sums_are_over_all_entries_before(count):
    sums = PrefixSum(capacity(count))
    values = np.random.default_rng(count).integers(-9, 9, sums.before.to_numpy().shape, dtype=np.int32)
    sums.before.from_numpy(values)
    sums.run(count)
    expected = np.concatenate([np.zeros((1, 2), int), np.cumsum(values[:count], axis=0)])
    assert np.array_equal(sums.before.to_numpy()[: count + 1], expected)
