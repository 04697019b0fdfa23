"""Points of a study with error bars: the mean over their members and its error."""

import numpy as np
import xarray as xr

from analysis.remnant.variables import COSTS, OUTCOMES, WITHOUT_ERROR
from analysis.results.statistics import difference, resolved, standard_error
from campaigns.members import ErrorBars
from engine.job.directory import JobState

MEMBERS = ("resolution", "seed")
"""Dimensions of the members of one point."""

_WORST_FIRST = (
    JobState.CORRUPT,
    JobState.UNREADABLE,
    JobState.FAILED,
    JobState.RUNNING,
    JobState.INTERRUPTED,
    JobState.PENDING,
    JobState.MISSING,
    JobState.DONE,
)
"""Of the states of its members, a point has the first in this order."""

_ERROR = (
    "sqrt(e^2 + (k d)^2) with the standard error e of the mean over seeds, the difference d of the means at both "
    "resolutions, and k = 1/(f^(-p/3) - 1) = {factor:.3g}, which makes of d the error of the finer resolution for "
    "order p = {order:g} in particle spacing and the fraction f = {coarser:g} of particles in the coarser one; NaN if "
    "e or d is unknown"
)
_RESOLVED = (
    "1 where the difference of the means at both resolutions exceeds the half-width of its 95 % confidence interval "
    "over seeds, 0 where not; NaN if one is unknown"
)


def combine(members: xr.Dataset, bars: ErrorBars) -> xr.Dataset:
    """Combine the members of each point: the mean over the seeds of the finer resolution, its error, and their number.

    `<variable>_error` adds, in quadrature, the standard error of that mean and the error of its resolution, which is
    its difference to the mean of the coarser one times `ErrorBars.error_over_difference`; it is NaN while one of them
    is unknown. `<variable>_resolved` is 1 where that difference exceeds its confidence interval over the seeds. Flags
    become a fraction of the seeds, costs the sum of all members.

    Args:
        members: the data set of all runs, with the dimensions `MEMBERS` last.
        bars: the resolutions, and the order by which their difference is extrapolated.
    """
    fine = members.sel(resolution="fine")
    first = fine.isel(seed=0, drop=True).drop_vars("resolution")
    points = first.drop_vars([*OUTCOMES, "state", "reason"])
    for name in OUTCOMES:
        points = points.assign(_measured(members[name], bars))
    return points.assign(_states(members)).assign_attrs(
        seeds=members["seed"].values.tolist(), members="two resolutions, coarse and fine, with all seeds: members.nc"
    )


def _measured(values: xr.DataArray, bars: ErrorBars) -> dict[str, xr.DataArray]:
    """The value of a point and, where it is a measured number, its error."""
    name, attributes = str(values.name), values.attrs
    fine, coarse = (values.sel(resolution=which, drop=True) for which in ("fine", "coarse"))
    if name in COSTS:
        return {name: _described(values.sum(MEMBERS, min_count=1), attributes, "sum of all members")}
    mean = _described(fine.mean("seed"), attributes, "mean over seeds at the finer resolution")
    if name in WITHOUT_ERROR:
        return {name: mean}
    factor = bars.error_over_difference
    error = ((factor * (mean - coarse.mean("seed"))) ** 2 + standard_error(fine) ** 2) ** 0.5
    about = {
        "long_name": f"error of the {attributes['long_name']}",
        "units": attributes["units"],
        "comment": _ERROR.format(factor=factor, order=bars.order, coarser=bars.coarser),
    }
    flag = {
        "long_name": f"significant change with resolution of the {attributes['long_name']}",
        "units": "1",
        "comment": _RESOLVED,
    }
    return {
        name: mean,
        f"{name}_error": error.assign_attrs(about),
        f"{name}_resolved": resolved(*difference(fine, coarse)).assign_attrs(flag),
    }


def _states(members: xr.Dataset) -> dict[str, xr.DataArray]:
    """A point is done when all its members are; else it has the state and the reason of its worst member."""
    state, reason = members["state"], members["reason"]
    found = state.isel(resolution=0, seed=0, drop=True)
    for one in reversed(_WORST_FIRST):
        found = found.where(~(state == one).any(MEMBERS), one.value)
    told = reason.where(state == found, "")
    why = xr.apply_ufunc(_first, told, input_core_dims=[MEMBERS], vectorize=True, output_dtypes=[object])
    done = (state == JobState.DONE).sum(MEMBERS).assign_attrs(long_name="members that are done", units="1")
    return {"state": found.assign_attrs(state.attrs), "reason": why.assign_attrs(reason.attrs), "members": done}


def _first(texts: np.ndarray) -> str:
    return next((str(text) for text in texts.flat if text), "")


def _described(values: xr.DataArray, attributes: dict[str, str], what: str) -> xr.DataArray:
    comment = "; ".join(filter(None, [attributes.get("comment", ""), what]))
    return values.assign_attrs({**attributes, "comment": comment})
