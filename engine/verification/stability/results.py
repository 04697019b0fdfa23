"""All outcomes as a data set, a table and a summary."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from engine import PHYSICS_VERSION
from engine.job.storage import write_dataset
from engine.verification.stability.heat_map import draw
from engine.verification.stability.measures import as_numbers
from engine.verification.stability.outcome import FAILED, STABLE, STOPPED, CaseResult
from engine.verification.stability.von_neumann import Limit

ATTRIBUTES = {
    "physical": ("whether the case must run to its end", "1"),
    "verdict": ("how it ended: stable, stopped or failed", "1"),
    "reason": ("why it was stopped or failed", "1"),
    "steps": ("time steps done", "1"),
    "progress": ("fraction of the simulated time that was reached", "1"),
    "cpu_time": ("CPU time of the run, compilation included", "s"),
    "mass_change": ("largest change of total mass, over total mass", "1"),
    "momentum_drift": ("largest change of momentum over mass times the speeds of the scene", "1"),
    "momentum_bound": ("largest momentum_drift of a stable run: one unit in the last place per time step", "1"),
    "energy_growth": ("largest growth of total energy, over the sum of all energies", "1"),
    "dissipation": ("loss of total energy from start to end, over the sum of all energies", "1"),
    "speed": ("highest speed", "m s-1"),
    "speed_bound": ("speed at which the guard stops", "m s-1"),
    "compression": ("highest rho/rho0", "1"),
    "compression_bound": ("rho/rho0 at which the guard stops", "1"),
    "nearest": ("largest ratio of a measure to its bound", "1"),
    "limit": ("largest stable c dt/dx of elastic waves of the longitudinal speed c, measured by bisection", "1"),
    "limit_theory": (
        "largest stable c dt/dx of elastic waves of the longitudinal speed c, from the matrix of a step",
        "1",
    ),
}


def dataset(outcomes: list[CaseResult], limits: list[Limit]) -> xr.Dataset:
    """Return the data set of all outcomes, dimension `case`, and limits of the time step, dimension `block`."""
    rows = [_row(outcome) for outcome in outcomes]
    columns: dict[str, tuple[str, NDArray[np.generic]]]
    columns = {name: ("case", np.array([row[name] for row in rows])) for name in rows[0]}
    columns["limit"] = ("block", np.array([limit.measured for limit in limits]))
    columns["limit_theory"] = ("block", np.array([limit.theory for limit in limits]))
    columns["block"] = ("block", np.array([limit.block for limit in limits]))
    attributes = {"Conventions": "CF-1.11", "title": "Stability of stiff and extreme cases"}
    result = xr.Dataset(columns, attrs={**attributes, "physics_version": PHYSICS_VERSION})
    for name, (long_name, units) in ATTRIBUTES.items():
        result[name].attrs = {"long_name": long_name, "units": units}
    return result.set_coords(["group", "name", "precision"])


def _row(outcome: CaseResult) -> dict[str, object]:
    own = {field.name: getattr(outcome, field.name) for field in fields(outcome) if field.name != "measures"}
    return {**own, "physical": np.int8(outcome.physical), **as_numbers(outcome.measures)}


def cases(results: xr.Dataset) -> pd.DataFrame:
    """Return a table of the outcomes, one row a case."""
    return results.drop_dims("block").to_dataframe().reset_index(drop=True)


def summary(results: xr.Dataset) -> pd.DataFrame:
    """Return a table with one row a group: how its cases ended, and the largest of their measures."""
    table = cases(results)
    counts = pd.DataFrame({verdict: table["verdict"] == verdict for verdict in (STABLE, STOPPED, FAILED)})
    extremes = table[["steps", "momentum_drift", "energy_growth", "dissipation", "nearest"]]
    groups = table["group"]
    return counts.groupby(groups, sort=False).sum().join(extremes.groupby(groups, sort=False).max())


def write(directory: Path, results: xr.Dataset) -> None:
    """Write stability.nc, stability.csv and stability.png."""
    write_dataset(directory / "stability.nc", results)
    cases(results).to_csv(directory / "stability.csv", index=False, float_format="%.4g")
    draw(cases(results)).savefig(directory / "stability.png", dpi=80)
