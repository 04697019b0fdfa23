"""Particles as a data set: what follows from the state."""

import numpy as np
import pytest

from engine.job.snapshot import FIELDS, snapshot
from engine.quantities import PARTICLES
from engine.state.particles import Arrays

RHO0 = np.array([2700.0, 2700.0, 900.0])


def state() -> Arrays:
    return {
        "x": np.arange(9.0).reshape(3, 3),
        "v": -np.arange(9.0).reshape(3, 3),
        "mass": np.array([1.0, 2.0, 3.0]),
        "j": np.array([0.0, -0.5, 1.0]),
        "E": np.array([0.0, 5.0, 1e-3]),
        "damage_root": np.array([0.0, 0.5, 1.0]),
        "plastic_dilation": np.array([0.0, 0.0, 0.25]),
        "body": np.array([0, 0, 1], dtype=np.int32),
    }


def test_density_and_damage_follow_from_volume_and_cube_root() -> None:
    dataset = snapshot(state(), RHO0, {"time": 7.0})
    assert np.array_equal(dataset["J"], [1.0, 0.5, 2.0])
    assert np.array_equal(dataset["rho"], [2700.0, 5400.0, 450.0])
    assert np.array_equal(dataset["damage"], [0.0, 0.125, 1.0])
    assert np.array_equal(dataset["packing"], [1.0, 1.0, 1.25])
    assert dataset.attrs["time"] == 7.0


def test_rock_as_dense_as_it_was_has_no_packing() -> None:
    assert "packing" not in snapshot({**state(), "plastic_dilation": np.zeros(3)}, RHO0, {})


def test_every_variable_has_its_unit_and_vectors_their_space() -> None:
    dataset = snapshot(state(), RHO0, {})
    assert set(dataset.data_vars) == set(PARTICLES)
    for name, quantity in PARTICLES.items():
        assert dataset[name].attrs["units"] == quantity.units
        assert dataset[name].dims == (("particle", "space") if quantity.is_vector else ("particle",))
    assert np.array_equal(dataset["velocity"].sel(space="z"), [-2.0, -5.0, -8.0])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_precision_on_disk_is_chosen_for_all_but_indices(dtype: type) -> None:
    dataset = snapshot(state(), RHO0, {}, dtype)
    assert {str(dataset[name].dtype) for name in dataset.data_vars if name != "body"} == {np.dtype(dtype).name}
    assert dataset["body"].dtype == np.int32


@pytest.mark.parametrize("name", FIELDS)
def test_every_field_is_needed(name: str) -> None:
    with pytest.raises(KeyError, match=name):
        snapshot({key: values for key, values in state().items() if key != name}, RHO0, {})
