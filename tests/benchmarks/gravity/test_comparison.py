"""What the comparison of codes rests on, without timing anything."""

import numpy as np
import pytest

from tests.benchmarks.gravity.states import along_curve, sphere
from tests.benchmarks.gravity.tables import time_at


def test_times_at_equal_error_follow_a_power_law_between_points():
    rows = [{"percentile_99": error, "cpu_ms": 3.0 / np.sqrt(error)} for error in (1e-4, 1e-3, 1e-2)]
    assert time_at(rows, 4e-3) == pytest.approx(3.0 / np.sqrt(4e-3), rel=1e-12)
    assert np.isnan(time_at(rows, 2e-2))


def test_a_morton_curve_keeps_all_particles_and_brings_neighbours_together():
    given = sphere(1000)
    sorted_ = along_curve(given)
    np.testing.assert_array_equal(np.sort(sorted_.x, axis=0), np.sort(given.x, axis=0))
    before, after = (np.linalg.norm(np.diff(state.x, axis=0), axis=1).mean() for state in (given, sorted_))
    assert after < 0.25 * before
