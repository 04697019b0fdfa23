"""Means and intervals against textbook numbers."""

import numpy as np
import pytest
import xarray as xr

from analysis.results.statistics import difference, interval, paired_difference, resolved, standard_error


def seeds(*values: float) -> xr.DataArray:
    return xr.DataArray(list(values), dims="seed")


def test_interval_is_student_s() -> None:
    values = seeds(1.0, 2.0, 3.0, 4.0, 5.0)
    assert standard_error(values) == pytest.approx(np.sqrt(2.5 / 5.0))
    assert interval(values) == pytest.approx(
        2.776445 * np.sqrt(0.5), rel=1e-6
    )  # t of 4 degrees of freedom, from tables


def test_unknown_values_do_not_count() -> None:
    assert interval(seeds(1.0, np.nan, 3.0)) == interval(seeds(1.0, 3.0))


@pytest.mark.parametrize("few", [seeds(1.0), seeds(np.nan, 1.0), seeds(np.nan)])
def test_a_single_value_has_no_interval(few: xr.DataArray) -> None:
    assert np.isnan(standard_error(few)) and np.isnan(interval(few))


def test_half_widths_add_in_quadrature() -> None:
    one, other = seeds(1.0, 2.0, 3.0), seeds(5.0, 5.5)
    change, half = difference(one, other)
    assert change == pytest.approx(-3.25)
    assert half == pytest.approx(np.hypot(interval(one), interval(other)))


def test_a_single_value_scatters_like_the_others() -> None:
    many = seeds(1.0, 2.0, 3.0, 4.0, 5.0)
    _, half = difference(many, seeds(9.0))
    assert half == pytest.approx(2.776445 * np.sqrt(2.5) * np.sqrt(1.0 + 1.0 / 5.0), rel=1e-6)


def test_a_difference_is_resolved_beyond_its_interval() -> None:
    values = seeds(1.0, 2.0, 3.0)
    half = float(difference(values, values)[1])
    assert resolved(*difference(values, values + 0.99 * half)) == 0.0
    assert resolved(*difference(values, values + 1.01 * half)) == 1.0
    assert np.isnan(resolved(*difference(seeds(1.0), seeds(2.0))))
    assert np.isnan(resolved(*difference(values, seeds(np.nan))))


def test_what_a_seed_does_to_both_cancels_in_pairs() -> None:
    values = seeds(1.0, 20.0, 300.0, np.nan)
    change, half = paired_difference(values, values + seeds(0.4, 0.5, 0.6, 0.7))
    assert change == pytest.approx(-0.5)
    assert half == pytest.approx(interval(seeds(0.4, 0.5, 0.6)))


def test_intervals_hold_the_mean_as_often_as_they_say() -> None:
    sample = xr.DataArray(np.random.default_rng(1).normal(size=(20000, 4)), dims=("case", "seed"))
    held = abs(sample.mean("seed")) < interval(sample)
    assert abs(float(held.mean()) - 0.95) < 0.006  # four standard deviations of a share of 20,000
