"""When the shape of a remnant counts as settled."""

from pathlib import Path

import numpy as np
import pytest

from analysis.remnant.particles import read_particles
from analysis.remnant.settling import TOLERANCE, is_settled, shape_change
from engine.errors import JobError
from engine.job.directory import JobDirectory
from engine.job.storage import write_dataset
from tests.helpers.fake_jobs import lattice_ellipsoid, particles

POINTS, SPACING = lattice_ellipsoid((2e5, 1e5, 8e4), 300)


def change(job: Path, stretches: dict[float, float], end: float = 10000.0) -> float:
    """The shape change of a body that was `1 + stretch` times as long in snapshots at the given times."""
    (job / "snapshots").mkdir()
    for time, stretch in stretches.items():
        longer = POINTS * np.array([1.0 + stretch, 1.0, 1.0])
        write_dataset(job / "snapshots" / f"{time:.3f}.nc", particles(longer, SPACING, time=time))
    write_dataset(job / "final.nc", particles(POINTS, SPACING, time=end))
    return shape_change(read_particles(job / "final.nc"), JobDirectory(job))


def test_the_largest_change_in_the_last_tenth_counts(tmp_path: Path) -> None:
    found = change(tmp_path, {2000.0: 0.3, 9000.0: 0.01, 9500.0: 0.05, 9900.0: 0.0})
    np.testing.assert_allclose(found, 0.05 / 1.05, rtol=0.02)
    assert is_settled(found) == 0.0


def test_a_shape_at_rest_is_settled(tmp_path: Path) -> None:
    assert is_settled(change(tmp_path, {5000.0: 0.3, 8500.0: 0.01, 9500.0: 0.0})) == 1.0


@pytest.mark.parametrize("times", [[], [9500.0], [4000.0], [-400.0]])
def test_unknown_without_a_snapshot_of_the_right_age(tmp_path: Path, times: list[float]) -> None:
    found = change(tmp_path, dict.fromkeys(times, 0.0))
    assert np.isnan([found, is_settled(found)]).all()


def test_unknown_before_contact(tmp_path: Path) -> None:
    assert np.isnan(change(tmp_path, {-500.0: 0.0, -300.0: 0.0}, end=-200.0))


def test_the_tolerance_itself_is_not_settled() -> None:
    assert is_settled(TOLERANCE) == 0.0


def test_a_damaged_snapshot_is_named(tmp_path: Path) -> None:
    (tmp_path / "snapshots").mkdir()
    (tmp_path / "snapshots" / "9000.000.nc").write_text("not netCDF")
    write_dataset(tmp_path / "final.nc", particles(POINTS, SPACING, time=10000.0))
    with pytest.raises(JobError, match=r"9000\.000\.nc: not a snapshot"):
        shape_change(read_particles(tmp_path / "final.nc"), JobDirectory(tmp_path))
