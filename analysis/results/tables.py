"""The points of a study as tables, for the terminal, for a file and for the figures."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pandas as pd
import xarray as xr

from analysis.results.variables import NONE
from engine.job.storage import write_atomically

HEADINGS = {
    "velocity": "v [m/s]",
    "angle": "angle [deg]",
    "mass_ratio": "M_lr/M_t",
    "second_mass_ratio": "second",
    "bound_mass_ratio": "bound",
    "b_over_a": "b/a",
    "c_over_a": "c/a",
    "c_over_a_extended": "c/a ext.",
    "bulk_density": "density [kg/m3]",
    "spin_period": "period [h]",
    "clumps": "clumps",
    "c_unresolved": "thin",
    "settled": "settled",
    "time_after_contact": "t [s]",
    "members": "members",
    "state": "state",
}
"""Columns of the printed table."""

DECIMALS = {
    "M_lr/M_t": 3,
    "second": 3,
    "bound": 3,
    "b/a": 2,
    "c/a": 2,
    "c/a ext.": 2,
    "density [kg/m3]": 0,
    "period [h]": 2,
}

NOT_A_SERIES = ("velocity", "angle", "end_time", "seed", "case")
"""Coordinates in which the points of one series of collisions may differ."""


def points(results: xr.Dataset) -> pd.DataFrame:
    """One row per point, with every coordinate and variable of a results data set as a column."""
    return results.reset_coords().to_dataframe().reset_index()


def series(results: xr.Dataset) -> Iterator[tuple[str, pd.DataFrame]]:
    """The points grouped by every parameter but velocity, angle and seed: a name, empty for a single one, and rows."""
    table = points(results)
    hidden = [name for name in NOT_A_SERIES if not (name == "end_time" and name in results.dims)]
    names = [str(name) for name in results.coords if name not in hidden and table[name].nunique(dropna=False) > 1]
    if not names:
        yield "", table
        return
    for values, rows in table.groupby(names, sort=False, dropna=False):
        pairs = zip(_labels(names), values, strict=True)
        yield ", ".join(f"{label} {NONE if value != value else _text(value)}" for label, value in pairs), rows


def _labels(names: list[str]) -> list[str]:
    """Short names of parameters: constants of a material by their last part, where that tells them apart."""
    last = [name.rpartition(".")[2] if name.startswith("materials.") else name for name in names]
    return [short if last.count(short) == 1 else name for name, short in zip(names, last, strict=True)]


def shape_table(results: xr.Dataset) -> pd.DataFrame:
    """The table of shape against angle: dimensions, velocity, angle, and the outcomes in `HEADINGS`, with errors."""
    errors = [name for heading in HEADINGS for name in (heading, f"{heading}_error") if name in results]
    names = dict.fromkeys([*(str(dim) for dim in results.dims), *errors])
    return points(results)[list(names)]


def write_shape_table(results: xr.Dataset, path: Path) -> None:
    """Write the table with full digits and the names of the data set, as CSV."""
    table = shape_table(results)
    write_atomically(path, lambda file: table.to_csv(file, index=False))


def printed(table: pd.DataFrame) -> str:
    """The table as a text with short headings, for a terminal."""
    shown, formatters = as_shown(table)
    return shown.to_string(index=False, formatters=formatters, na_rep="-")


def as_shown(table: pd.DataFrame) -> tuple[pd.DataFrame, dict[str, Callable[[object], str]]]:
    """The table with short headings and value +- error, and how to write each column; a dash stands for no value."""
    hours = {name: table[name] / 3600.0 for name in ("spin_period", "spin_period_error") if name in table}
    shown = _with_errors(table.assign(**hours)).rename(columns=HEADINGS)
    return shown, {name: partial(_text, decimals=DECIMALS.get(name)) for name in shown.columns}


def _with_errors(table: pd.DataFrame) -> pd.DataFrame:
    """Each column that has an error as text, value +- error."""
    for error in [name for name in table.columns if name.endswith("_error")]:
        name = error.removesuffix("_error")
        decimals = DECIMALS.get(HEADINGS[name])
        pairs = zip(table[name], table[error], strict=True)
        texts = [_text(value, decimals) + f" +- {_text(bar, decimals)}" * (value == value) for value, bar in pairs]
        table = table.assign(**{name: texts}).drop(columns=error)
    return table


def unresolved(results: xr.Dataset) -> list[str]:
    """One line a point that names the outcomes of the table whose change with resolution is not significant."""
    names = [name for name in HEADINGS if f"{name}_resolved" in results]
    table = points(results)
    lines = []
    for _, row in table.iterrows():
        same = [HEADINGS[name] for name in names if row[f"{name}_resolved"] == 0.0]
        if same:
            point = ", ".join(f"{dim} {_text(row[dim])}" for dim in map(str, results.dims))
            lines.append(f"{point}: no change with resolution beyond the scatter of the seeds: {', '.join(same)}")
    return lines


def reasons(results: xr.Dataset, *states: str) -> list[str]:
    """One line per job that has a reason for having no outcome, of all jobs or of those in the given states."""
    table = points(results)
    without = table[(table["reason"] != "") & (table["state"].isin(states) if states else True)]
    return [f"{row.job}: {row.state}: {row.reason}" for row in without.itertuples()]


def markdown_table(heads: list[str], rows: list[list[str]]) -> str:
    """Return a table of texts in Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _text(value: object, decimals: int | None = None) -> str:
    if not isinstance(value, float):
        return str(value)
    if value != value:
        return "-"
    return f"{value:.{decimals}f}" if decimals is not None else f"{value:.6g}"
