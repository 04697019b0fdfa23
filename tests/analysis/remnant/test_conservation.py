"""Drifts against numbers worked out from the scene."""

from pathlib import Path

import numpy as np
import pytest

from analysis.remnant.conservation import drifts, read_history
from engine.errors import JobError
from engine.job.storage import write_dataset
from engine.scene.collision import Collision
from engine.scene.scene import Scene
from tests.helpers.fake_jobs import history

TIMES = np.linspace(-500.0, 1000.0, 4)


def scene(angle: float) -> Scene:
    return Collision(velocity=200.0, angle=angle, particles=100, end_time=1000.0).scene()


def test_each_drift_is_relative_to_its_own_scale() -> None:
    found = drifts(history(TIMES, 1e-3), scene(15.0)).isel(time=-1)
    body = scene(15.0).bodies[0]
    momentum = 2.0 * body.mass * np.linalg.norm(body.velocity)
    angular_momentum = 2.0 * body.mass * np.linalg.norm(np.cross(body.position, body.velocity))
    np.testing.assert_allclose(found["mass"], 1e-3)
    np.testing.assert_allclose(found["momentum"], 1e-3 * 1e20 / momentum)
    np.testing.assert_allclose(found["angular_momentum"], 1e-3 * 1e25 / angular_momentum)
    np.testing.assert_allclose(found["total_energy"], 1e-3 * 5e21 / 5e21)


def test_mass_and_energy_keep_the_sign_of_their_change() -> None:
    found = drifts(history(TIMES, -1e-3), scene(15.0)).isel(time=-1)
    assert found["mass"] < 0.0 and found["total_energy"] < 0.0 and found["momentum"] > 0.0


def test_a_head_on_impact_has_no_angular_momentum_to_compare_with() -> None:
    assert np.isnan(drifts(history(TIMES, 1e-3), scene(0.0))["angular_momentum"]).all()


def test_a_history_without_a_quantity_is_refused(tmp_path: Path) -> None:
    write_dataset(tmp_path / "history.nc", history(TIMES).drop_vars("momentum"))
    with pytest.raises(JobError, match=r"history\.nc: not a history: lacks momentum"):
        read_history(tmp_path / "history.nc")
    write_dataset(tmp_path / "empty.nc", history(TIMES).isel(time=slice(0, 0)))
    with pytest.raises(JobError, match="lacks any row"):
        read_history(tmp_path / "empty.nc")
