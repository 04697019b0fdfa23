"""Means over seeds, and which of their differences the seeds resolve."""

import numpy as np
import xarray as xr
from scipy.stats import t as student

Difference = tuple[xr.DataArray, xr.DataArray]

CONFIDENCE = 0.95
"""Probability that an interval holds the mean."""


def count(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """How many values along `dim` are known."""
    return values.notnull().sum(dim)


def spread(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """Standard deviation of one value along `dim`; NaN for fewer than two."""
    return values.std(dim, ddof=1).where(count(values, dim) > 1)


def standard_error(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """Standard error of the mean along `dim`; NaN for fewer than two."""
    return spread(values, dim) / np.sqrt(count(values, dim))


def interval(values: xr.DataArray, dim: str = "seed") -> xr.DataArray:
    """Half the width of the confidence interval of the mean along `dim`, by Student's t; NaN for fewer than two."""
    return _quantile(count(values, dim)) * standard_error(values, dim)


def difference(values: xr.DataArray, other: xr.DataArray, dim: str = "seed") -> Difference:
    """Difference of the means of two independent samples, and half the width of its confidence interval.

    The half-widths of the two means add in quadrature. A mean of a single value has none of its own: it is taken to
    scatter like the values it is compared with (prediction interval of one observation).

    Args:
        values, other: values along `dim`.
        dim: dimension over which both are averaged.
    """
    half = (_half(values, other, dim) ** 2 + _half(other, values, dim) ** 2) ** 0.5
    return values.mean(dim) - other.mean(dim), half


def paired_difference(values: xr.DataArray, other: xr.DataArray, dim: str = "seed") -> Difference:
    """Mean of the differences one by one along `dim`, and half the width of its confidence interval.

    What both samples share at the same place, as the particles and flaws of a seed, cancels.
    """
    change = values - other
    return change.mean(dim), interval(change, dim)


def resolved(change: xr.DataArray, half: xr.DataArray) -> xr.DataArray:
    """1 where a difference exceeds half the width of its confidence interval, 0 where not, NaN where unknown."""
    return (abs(change) > half).astype(float).where(change.notnull() & half.notnull())


def _half(values: xr.DataArray, other: xr.DataArray, dim: str) -> xr.DataArray:
    alone = _quantile(count(other, dim)) * spread(other, dim)
    return interval(values, dim).where(count(values, dim) > 1, alone.where(count(values, dim) == 1))


def _quantile(number: xr.DataArray) -> xr.DataArray:
    """Student's t of `number` values."""
    return number.copy(data=student.ppf(0.5 + 0.5 * CONFIDENCE, np.maximum(number.data - 1, 1)))
