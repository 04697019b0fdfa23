"""The data set of accuracy: means over seeds, their differences to the base and to the finest case, and their cost."""

import numpy as np
import xarray as xr

from analysis.accuracy.cases import BASE, RESOLUTION, VariedCase
from analysis.accuracy.orders import orders
from analysis.remnant.variables import DRIFTS, OUTCOMES
from analysis.results.statistics import Difference, count, difference, interval, paired_difference, resolved
from engine.job.directory import JobState

MEASURED = ("mass_ratio", "b_over_a", "c_over_a", "bulk_density")
"""Outcomes that are compared."""

_INTERVAL = "half the width of the 95 % confidence interval, Student's t over seeds"
_PAIRED = (
    "seed by seed between cases of equal resolution, whose bodies are the same; "
    "else of the means, a case of one seed being taken to scatter like the one it is compared with"
)
_RESOLVED = "1 where the difference exceeds its interval, 0 where not"


def accuracy(results: xr.Dataset, cases: dict[str, VariedCase]) -> xr.Dataset:
    """Return outcomes and cost of every case with a finished run, and differences to the base and the finest case.

    Args:
        results: the results of a campaign, dimensions case and seed.
        cases: the setting that each case varies, by name of the case.
    """
    done = results.sel(case=(results["state"] == JobState.DONE).any("seed").values)
    finest = _finest([str(name) for name in done["case"].values], cases)
    data = _described(done, cases)
    for name in MEASURED:
        data = data.assign(_mean(done[name]))
        for role, other in {"base": BASE, "finest": finest}.items():
            data = data.assign(_change(done[name], data, other, role))
    for name in (*DRIFTS, "cpu_time", "steps"):
        data = data.assign(_mean(abs(done[name]).assign_attrs(done[name].attrs)))
    return data.assign(orders(data, finest)).assign_attrs(finest=finest)


def _described(done: xr.Dataset, cases: dict[str, VariedCase]) -> xr.Dataset:
    chosen = [cases[str(name)] for name in done["case"].values]
    spacing = np.array([(4.0 * np.pi / 3.0 / case.particles) ** (1.0 / 3.0) for case in chosen])
    runs = count(done["mass_ratio"]).assign_attrs(long_name="runs that are done", units="1")
    return xr.Dataset(
        {"runs": runs},
        coords={
            "case": ("case", [str(name) for name in done["case"].values], {"long_name": "name of the case"}),
            "setting": ("case", [case.setting for case in chosen], {"long_name": "setting that differs from the base"}),
            "value": ("case", [str(case.value) for case in chosen], {"long_name": "value of that setting"}),
            "particles": ("case", [case.particles for case in chosen], {"long_name": "particles a body", "units": "1"}),
            "spacing": ("case", spacing, {"long_name": "particle spacing in radii of the target", "units": "1"}),
        },
        attrs={"Conventions": "CF-1.11", "title": "Accuracy and cost of numerical settings", **_origin(done)},
    )


def _origin(done: xr.Dataset) -> dict[str, object]:
    """Attributes of the campaign, and the parameters that have one value in all runs."""
    known = {str(name): values.values[values.notnull().values] for name, values in done.coords.items()}
    return {**done.attrs, **{name: values[0] for name, values in known.items() if len(np.unique(values)) == 1}}


def _finest(names: list[str], cases: dict[str, VariedCase]) -> str:
    return max((name for name in names if cases[name].setting in RESOLUTION), key=lambda name: cases[name].particles)


def _mean(values: xr.DataArray) -> dict[str, xr.DataArray]:
    name, variable = str(values.name), OUTCOMES[str(values.name)]
    size = "mean of the size over seeds" if name in DRIFTS else "mean over seeds"
    about = {"long_name": f"interval of the {variable.long_name}", "units": variable.units, "comment": _INTERVAL}
    return {
        name: values.mean("seed").assign_attrs({**variable.attributes(), "comment": size}),
        f"{name}_interval": interval(values).assign_attrs(about),
    }


def _change(values: xr.DataArray, data: xr.Dataset, other: str, role: str) -> dict[str, xr.DataArray]:
    """Difference of every case to another one; NaN for that one itself."""
    reference = values.sel(case=other, drop=True)
    elsewhere = values["case"] != other
    change, half = _difference(values, reference, same_bodies=data["particles"] == data["particles"].sel(case=other))
    name, variable = f"{values.name}_minus_{role}", OUTCOMES[str(values.name)]
    long_name = f"{variable.long_name}, minus that of the {role} case"
    units = {"units": variable.units}
    return {
        name: change.where(elsewhere).assign_attrs(long_name=long_name, **units),
        f"{name}_interval": half.where(elsewhere).assign_attrs(
            long_name=f"interval of the {long_name}", comment=f"{_INTERVAL}; {_PAIRED}", **units
        ),
        f"{name}_resolved": resolved(change, half)
        .where(elsewhere)
        .assign_attrs(long_name=f"resolved: {long_name}", units="1", comment=_RESOLVED),
    }


def _difference(values: xr.DataArray, reference: xr.DataArray, same_bodies: xr.DataArray) -> Difference:
    """Seed by seed where the same seed gives the same bodies, else of the means."""
    pairs, means = paired_difference(values, reference), difference(values, reference)
    change, half = (pair.where(same_bodies, mean) for pair, mean in zip(pairs, means, strict=True))
    return change, half
