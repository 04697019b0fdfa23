"""One row for each method in each collision: this campaign, other methods, and a scaling law."""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from analysis.comparison.scaling import largest_remnant
from analysis.results.statistics import count, spread
from analysis.results.variables import NONE
from engine.errors import SceneError

REFERENCES = Path(__file__).with_name("references.csv")
"""What other methods find; empty where a source gives no number."""

COLLISION = ["velocity", "angle"]
"""Columns that say which collision a row is of."""

MEASURED = ["mass_ratio", "second_mass_ratio", "bound_mass_ratio", "b_over_a", "c_over_a"]
"""Columns that are compared."""

RADIUS = 50e3
"""Of both bodies in all references [m]."""

FRICTION = "materials.basalt.friction"
"""Setting that a row names if it is not that of all rows."""

OWN = "this study"
"""Method of the rows of the campaign."""


def label(method: str, material: str) -> str:
    """Return what a row is called."""
    return f"{method}, {material}" if material else method


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
    others = references() if _radii(results) == (RADIUS, RADIUS) else references().iloc[:0]
    rows = pd.concat([own, others, scaling_rows(results, collisions)], ignore_index=True)
    order = {tuple(pair): i for i, pair in enumerate(collisions.to_numpy())}
    place = [order.get(pair, -1) for pair in zip(rows["velocity"], rows["angle"], strict=True)]
    return rows.assign(place=place).query("place >= 0").sort_values("place", kind="stable").drop(columns="place")


def own_rows(results: xr.Dataset) -> pd.DataFrame:
    """Return means over seeds, and their standard deviations `<name>_spread`, of every case that has a finished run."""
    allowed = {"case", "seed"} <= set(results.dims) and not set(COLLISION) & set(results.dims)
    if not allowed:
        raise SceneError(
            "the campaign needs [[cases]] that give velocity and angle, the axis seed and no [error_bars], as the "
            f"study comparison has them; its dimensions are {', '.join(map(str, results.dims))}"
        )
    if not results["mass_ratio"].notnull().any():
        raise SceneError("no run of the campaign is done yet; run it first")
    table = xr.Dataset({"runs": count(results["mass_ratio"])})
    for name in MEASURED:
        table[name], table[f"{name}_spread"] = results[name].mean("seed"), spread(results[name])
    table["time"] = results["time_after_contact"].mean("seed")
    for name in (*COLLISION, "particles", FRICTION):
        table[name] = _setting(results, name)
    rows = table.to_dataframe().reset_index().query("runs > 0")
    others = [str(name) for name in results.dims if name not in ("case", "seed")]
    return rows.assign(method=OWN, material=_materials(rows, others)).drop(columns=["case", *others])


def _setting(results: xr.Dataset, name: str) -> xr.DataArray:
    """A setting of every row; not a number where no run has it."""
    given = results[name] if name in results.variables else xr.DataArray(results.attrs.get(name, np.nan))
    return given.max("seed") if "seed" in given.dims else given


def _materials(rows: pd.DataFrame, others: list[str]) -> pd.Series:
    """What tells rows of one collision apart: case if several are of it, the other axes, friction if it varies."""
    several = rows.groupby([*COLLISION, "particles", *others], dropna=False)["case"].transform("nunique") > 1
    parts = rows[["case", *others]].astype(str).assign(case=rows["case"].where(several, ""))
    if rows[FRICTION].nunique() > 1:
        parts[FRICTION] = rows[FRICTION].map("friction {:.3g}".format)
    return pd.Series([", ".join(filter(None, row)) for row in parts.to_numpy()], index=rows.index)


def scaling_rows(results: xr.Dataset, collisions: pd.DataFrame) -> pd.DataFrame:
    """Return what scaling without friction says of the bound mass, if all runs have the same radii and one material."""
    radii = _radii(results)
    densities = [value for key, value in results.attrs.items() if str(key).endswith(".rho0")]
    if radii is None or len(densities) != 1:
        return collisions.iloc[:0]
    target, projectile = (4.0 / 3.0 * np.pi * float(densities[0]) * r**3 for r in radii)
    bound = [largest_remnant((target, projectile), radii, *pair) for pair in collisions.to_numpy()]
    return collisions.assign(method="scaling", material="no friction", bound_mass_ratio=bound)


def _radii(results: xr.Dataset) -> tuple[float, float] | None:
    """Radii of target and projectile [m], if all runs have the same."""
    target, projectile = (results.attrs.get(f"{body}.radius") for body in ("target", "projectile"))
    if target in (None, NONE) or projectile is None:
        return None
    return float(target), float(target if projectile == NONE else projectile)
