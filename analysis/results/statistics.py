"""Means over seeds, their confidence intervals, and which of their differences are significant."""

import numpy as np
import xarray as xr
from scipy.stats import t as student

Difference = tuple[xr.DataArray, xr.DataArray]

CONFIDENCE = 0.95
"""Confidence level of every interval: the probability that it contains the mean."""


def count(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """Number of values along `dim` that are not NaN."""
    return values.notnull().sum(dim)


def spread(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """Standard deviation s of a value along `dim`, with n - 1 in the denominator; NaN for fewer than two."""
    return values.std(dim, ddof=1).where(count(values, dim) > 1)


def standard_error(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """Standard error of the mean along `dim`, s/sqrt(n); NaN for fewer than two."""
    return spread(values, dim) / np.sqrt(count(values, dim))


def interval(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """Half-width of the confidence interval of the mean along `dim`, t s/sqrt(n); NaN for fewer than two."""
    return _quantile(count(values, dim)) * standard_error(values, dim)


def difference(values: xr.DataArray, other: xr.DataArray, dim: str = "seed") -> Difference:
    """Difference of the means of two independent samples, and the half-width of its confidence interval.

    The half-widths of the two means add in quadrature. A single value has no standard deviation of its own: that of
    the other sample is taken (prediction interval of one observation).

    Args:
        values, other: values along `dim`.
        dim: dimension over which both are averaged.
    """
    half = (_half(values, other, dim) ** 2 + _half(other, values, dim) ** 2) ** 0.5
    return values.mean(dim) - other.mean(dim), half


def paired_difference(values: xr.DataArray, other: xr.DataArray, dim: str = "seed") -> Difference:
    """Mean of the differences value by value along `dim`, and the half-width of its confidence interval.

    Scatter that both samples have in common, as from the particles and flaws of one seed, cancels.

    Args:
        values, other: values along `dim`.
        dim: dimension over which both are averaged.
    """
    change = values - other
    return change.mean(dim), interval(change, dim)


def resolved(change: xr.DataArray, half: xr.DataArray) -> xr.DataArray:
    """1 where |change| > half, so that the difference is significant; 0 where not, NaN where one is unknown."""
    return (abs(change) > half).astype(float).where(change.notnull() & half.notnull())


def _half(values: xr.DataArray, other: xr.DataArray, dim: str) -> xr.DataArray:
    """Half-width of the interval of one mean; of a single value from the standard deviation of the others."""
    alone = _quantile(count(other, dim)) * spread(other, dim)
    return interval(values, dim).where(count(values, dim) > 1, alone.where(count(values, dim) == 1))


def _quantile(number: xr.DataArray) -> xr.DataArray:
    """Quantile t of Student's distribution for the mean of `number` values, with number - 1 degrees of freedom."""
    return number.copy(data=student.ppf(0.5 + 0.5 * CONFIDENCE, np.maximum(number.data - 1, 1)))
