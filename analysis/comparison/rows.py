"""One row for each method in each collision: this campaign, other methods, and a scaling law."""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from analysis.comparison.scaling import largest_remnant
from analysis.results.statistics import count, spread
from analysis.results.variables import NONE
from engine.errors import SceneError
from engine.job.directory import JobState

REFERENCES = Path(__file__).with_name("references.csv")
"""What other methods find; empty where a source gives no number."""

COLLISION = ["velocity", "angle"]
"""Columns that say which collision a row is of."""

MEASURED = ["mass_ratio", "second_mass_ratio", "bound_mass_ratio", "b_over_a", "c_over_a"]
"""Columns that are compared."""

OWN = "this study"
"""Method of the rows of the campaign."""


def references() -> pd.DataFrame:
    """Return what other methods find: velocity [m/s], angle [deg], method, material, particles a body, time [s]."""
    return pd.read_csv(REFERENCES).drop(columns="source")


def compared(results: xr.Dataset) -> pd.DataFrame:
    """Return the rows of all methods, by collision in the order of the campaign.

    Args:
        results: of a campaign with the dimensions case and seed, and any others, which tell its rows apart.

    Raises:
        SceneError: the campaign has no dimension case or seed, or no run of it is done.
    """
    own = own_rows(results)
    collisions = own[COLLISION].drop_duplicates()
    scaled = scaling_rows(results, collisions)
    rows = pd.concat([own, references().assign(runs=1.0), scaled], ignore_index=True)
    order = {tuple(pair): i for i, pair in enumerate(collisions.to_numpy())}
    place = [order.get(pair, -1) for pair in zip(rows["velocity"], rows["angle"], strict=True)]
    return rows.assign(place=place).query("place >= 0").sort_values("place", kind="stable").drop(columns="place")


def own_rows(results: xr.Dataset) -> pd.DataFrame:
    """Return means over seeds, and their standard deviations `<name>_spread`, of every case that has a finished run."""
    if not {"case", "seed"} <= set(results.dims):
        raise SceneError("the campaign needs [[cases]] and the axis seed, as the study comparison has them")
    done = results["state"] == JobState.DONE
    if not done.any():
        raise SceneError("no run of the campaign is done yet; run it first")
    table = xr.Dataset({"runs": count(results["mass_ratio"])})
    for name in MEASURED:
        table[name], table[f"{name}_spread"] = results[name].mean("seed"), spread(results[name])
    table["time"] = results["time_after_contact"].mean("seed")
    for name in COLLISION:
        table[name] = results[name].max("seed")
    rows = table.to_dataframe().reset_index().query("runs > 0")
    others = [str(name) for name in results.dims if name not in ("case", "seed")]
    material = rows[others].astype(str).agg(", ".join, axis=1) if others else ""
    return rows.assign(method=OWN, material=material, particles=_particles(results)).drop(columns=["case", *others])


def scaling_rows(results: xr.Dataset, collisions: pd.DataFrame) -> pd.DataFrame:
    """Return what scaling without friction says of the bound mass, if all collisions have one pair of bodies."""
    attributes = results.attrs
    radius, other = (str(attributes.get(f"{body}.radius", NONE)) for body in ("target", "projectile"))
    if radius == NONE:
        return collisions.iloc[:0]
    radii = float(radius), float(radius if other == NONE else other)
    density = float(next(value for key, value in attributes.items() if str(key).endswith(".rho0")))
    target, projectile = (4.0 / 3.0 * np.pi * density * r**3 for r in radii)
    bound = [largest_remnant((target, projectile), radii, *pair) for pair in collisions.to_numpy()]
    return collisions.assign(method="scaling", material="no friction", bound_mass_ratio=bound)


def _particles(results: xr.Dataset) -> float:
    return float(results.attrs.get("particles", np.nan))
