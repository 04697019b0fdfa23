"""The cells of a campaign as tables, for the terminal, for a file and for the figures."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pandas as pd
import xarray as xr

from engine.storage import write_atomically

HEADINGS = {
    "velocity": "v [m/s]",
    "angle": "angle [deg]",
    "mass_ratio": "M_lr/M_t",
    "bound_mass_ratio": "bound",
    "b_over_a": "b/a",
    "c_over_a": "c/a",
    "c_over_a_extended": "c/a ext.",
    "bulk_density": "density [kg/m3]",
    "spin_period": "period [h]",
    "clumps": "clumps",
    "largest_thin": "thin",
    "settled": "settled",
    "time_after_contact": "t [s]",
    "state": "state",
}
"""Columns of the printed table."""

DECIMALS = {"M_lr/M_t": 3, "bound": 3, "b/a": 2, "c/a": 2, "c/a ext.": 2, "density [kg/m3]": 0, "period [h]": 2}

NOT_A_SERIES = ("velocity", "angle", "end_time", "seed", "case")
"""Coordinates that do not tell one series of collisions from another."""


def cells(results: xr.Dataset) -> pd.DataFrame:
    """One row per cell, with every coordinate and variable of a results data set as a column."""
    return results.reset_coords().to_dataframe().reset_index()


def series(results: xr.Dataset) -> Iterator[tuple[str, pd.DataFrame]]:
    """The cells apart by every parameter but velocity, angle and seed: a name, empty for a single one, and its rows."""
    table = cells(results)
    names = [str(name) for name in results.coords if name not in NOT_A_SERIES and table[name].nunique(dropna=False) > 1]
    if not names:
        yield "", table
        return
    for values, rows in table.groupby(names, sort=False, dropna=False):
        pairs = zip(names, values, strict=True)
        yield ", ".join(f"{name} {_text(value)}" for name, value in pairs), rows


def shape_table(results: xr.Dataset) -> pd.DataFrame:
    """The table of shape against angle: dimensions, velocity, angle, and the outcomes in `HEADINGS`."""
    names = dict.fromkeys([*(str(dim) for dim in results.dims), *HEADINGS])
    return cells(results)[list(names)]


def write_shape_table(results: xr.Dataset, path: Path) -> None:
    """Write the table with full digits and the names of the data set, as CSV."""
    table = shape_table(results)
    write_atomically(path, lambda file: table.to_csv(file, index=False))


def printed(table: pd.DataFrame) -> str:
    """The table for people: short headings, few digits, a dash for what is not there."""
    shown = table.assign(spin_period=table["spin_period"] / 3600.0).rename(columns=HEADINGS)
    formatters = {name: partial(_text, decimals=DECIMALS.get(name)) for name in shown.columns}
    return shown.to_string(index=False, formatters=formatters, na_rep="-")


def reasons(results: xr.Dataset) -> list[str]:
    """One line per job that gives a reason for having no outcome."""
    table = cells(results)
    told = table[table["reason"] != ""]
    return [f"{row.job}: {row.state}: {row.reason}" for row in told.itertuples()]


def _text(value: object, decimals: int | None = None) -> str:
    if not isinstance(value, float):
        return str(value)
    if value != value:
        return "-"
    return f"{value:.{decimals}f}" if decimals is not None else f"{value:.6g}"
