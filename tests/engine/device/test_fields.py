import numpy as np
import pytest
import taichi as ti

from engine.device.backend import Real, vec3
from engine.device.fields import capacity, filled, overwrite, per_body

pytestmark = pytest.mark.usefixtures("taichi")


def test_scenes_of_many_sizes_share_few_sizes_of_fields():
    assert [capacity(count) for count in (0, 1, 1024, 1025, 2048, 20_000)] == [1024, 1024, 1024, 2048, 2048, 32_768]


def test_a_field_begins_with_its_values_and_ends_in_zeros():
    field = filled(ti.i32, np.arange(1, 6, dtype=np.int32))
    assert field.to_numpy().tolist() == [1, 2, 3, 4, 5] + [0] * 1019


def test_fewer_values_leave_nothing_of_those_before():
    field = vec3.field(shape=4)
    overwrite(field, np.ones((4, 3)))
    overwrite(field, np.array([[1.0, 2.0, 3.0]]))
    assert field.to_numpy().tolist() == [[1.0, 2.0, 3.0], *[[0.0] * 3] * 3]


def test_constants_are_stored_by_body_and_name():
    table = per_body(density=[1.0, 2.0, 3.0], modulus=[10.0, 20.0, 30.0])
    assert table.shape == (capacity(3),)
    for body in range(3):
        assert (table[body].density, table[body].modulus) == (body + 1.0, 10.0 * (body + 1.0))
    assert table.density.dtype == Real
