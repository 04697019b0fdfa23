"""The history as a data set, and back."""

import numpy as np
import xarray as xr

from engine.job.history import History
from engine.quantities import HISTORY
from engine.simulation.conservation import Row


def row(time: float) -> Row:
    values = {"time": time, "momentum": [time, 0.0, -1.0], "mass": 3.0 + time}
    return {name: np.asarray(value, dtype=np.float64) for name, value in values.items()}


def written(*times: float) -> xr.Dataset:
    history = History()
    for time in times:
        history.append(row(time))
    return history.dataset({"scene_hash": "abc"})


def test_rows_stand_along_time_and_vectors_along_space() -> None:
    dataset = written(0.0, 2.0)
    assert dataset["mass"].dims == ("time",) and dataset["momentum"].dims == ("time", "space")
    assert dataset["momentum"].sel(time=2.0, space="x") == 2.0
    assert dataset.attrs["scene_hash"] == "abc"
    for name in ("time", "mass", "momentum"):
        assert dataset[name].attrs["units"] == HISTORY[name].units


def test_a_history_is_the_same_after_it_was_written_and_read() -> None:
    dataset = written(0.0, 2.0, 5.0)
    again = History.from_dataset(dataset)
    xr.testing.assert_identical(again.dataset({"scene_hash": "abc"}), dataset)


def test_rows_go_on_after_those_that_are_kept() -> None:
    dataset = written(0.0, 2.0, 5.0)
    history = History.from_dataset(dataset.isel(time=dataset["time"] <= 2.0))
    history.append(row(3.0))
    xr.testing.assert_identical(history.dataset({"scene_hash": "abc"}), written(0.0, 2.0, 3.0))
