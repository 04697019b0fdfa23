"""When shape and mass of a remnant count as settled."""

from pathlib import Path

import numpy as np
import pytest

from analysis.remnant.particles import read_particles
from analysis.remnant.settling import TOLERANCE, Changes, recent_changes
from engine.errors import JobError
from engine.job.directory import JobDirectory
from engine.job.storage import write_dataset
from tests.helpers.fake_jobs import lattice_ellipsoid, particles

POINTS, SPACING = lattice_ellipsoid((2e5, 1e5, 8e4), 300)


def changes(job: Path, stretches: dict[float, float], more: float = 0.0, end: float = 10000.0) -> Changes:
    """The changes of a body that was `1 + stretch` times as long and `1 + more` times as heavy in earlier snapshots."""
    (job / "snapshots").mkdir()
    for time, stretch in stretches.items():
        earlier = particles(POINTS * np.array([1.0 + stretch, 1.0, 1.0]), SPACING, time=time)
        write_dataset(job / "snapshots" / f"{time:.3f}.nc", earlier.assign(mass=earlier["mass"] * (1.0 + more)))
    write_dataset(job / "final.nc", particles(POINTS, SPACING, time=end))
    return recent_changes(read_particles(job / "final.nc"), JobDirectory(job))


def test_the_largest_change_in_the_last_tenth_counts(tmp_path: Path) -> None:
    found = changes(tmp_path, {2000.0: 0.3, 9000.0: 0.01, 9500.0: 0.05, 9900.0: 0.0})
    np.testing.assert_allclose(found.shape, 0.05 / 1.05, rtol=0.02)
    assert found.mass == 0.0 and found.settled == 0.0


def test_shape_and_mass_at_rest_are_settled(tmp_path: Path) -> None:
    assert changes(tmp_path, {5000.0: 0.3, 8500.0: 0.01, 9500.0: 0.0}).settled == 1.0


@pytest.mark.parametrize(("more", "settled"), [(0.05, 0.0), (-0.05, 0.0), (0.01, 1.0)])
def test_a_remnant_that_gains_or_loses_mass_is_not_settled(tmp_path: Path, more: float, settled: float) -> None:
    found = changes(tmp_path, {9000.0: 0.0, 9500.0: 0.0}, more)
    np.testing.assert_allclose(found.mass, abs(more), rtol=1e-9)
    assert found.shape == pytest.approx(0.0, abs=1e-9) and found.settled == settled


def test_fragments_that_fall_back_change_the_mass(tmp_path: Path) -> None:
    (tmp_path / "snapshots").mkdir()
    falls = POINTS[:, 0] > 6e4
    before = POINTS + np.outer(falls, [9e5, 0.0, 0.0])
    write_dataset(tmp_path / "snapshots" / "9000.nc", particles(before, SPACING, time=9000.0))
    write_dataset(tmp_path / "final.nc", particles(POINTS, SPACING, time=10000.0))
    found = recent_changes(read_particles(tmp_path / "final.nc"), JobDirectory(tmp_path))
    np.testing.assert_allclose(found.mass, falls.mean(), rtol=1e-9)


@pytest.mark.parametrize("times", [[], [9500.0], [4000.0], [-400.0]])
def test_unknown_without_a_snapshot_of_the_right_age(tmp_path: Path, times: list[float]) -> None:
    found = changes(tmp_path, dict.fromkeys(times, 0.0))
    assert np.isnan([found.shape, found.mass, found.settled]).all()


def test_unknown_before_contact(tmp_path: Path) -> None:
    assert np.isnan(changes(tmp_path, {-500.0: 0.0, -300.0: 0.0}, end=-200.0).settled)


def test_the_tolerance_itself_is_not_settled() -> None:
    below = 0.99 * TOLERANCE
    assert Changes(below, below).settled == 1.0
    assert Changes(TOLERANCE, below).settled == 0.0 and Changes(below, TOLERANCE).settled == 0.0


def test_settled_is_unknown_when_one_change_is() -> None:
    assert np.isnan([Changes(float("nan"), 0.0).settled, Changes(0.0, float("nan")).settled]).all()


def test_a_damaged_snapshot_is_named(tmp_path: Path) -> None:
    (tmp_path / "snapshots").mkdir()
    (tmp_path / "snapshots" / "9000.000.nc").write_text("not netCDF")
    write_dataset(tmp_path / "final.nc", particles(POINTS, SPACING, time=10000.0))
    with pytest.raises(JobError, match=r"9000\.000\.nc: not a snapshot"):
        recent_changes(read_particles(tmp_path / "final.nc"), JobDirectory(tmp_path))
