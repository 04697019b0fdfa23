"""Tables and figure of a campaign beside other methods."""

from pathlib import Path

import pandas as pd
import xarray as xr

from analysis.comparison.figure import beside_other_methods
from analysis.comparison.rows import COLLISION, MEASURED, compared, label
from analysis.report.figures.style import save
from analysis.results.collect import collect
from analysis.results.tables import markdown_table
from engine.job.storage import write_text

HEADS = ["method", "particles", "runs", "t [s]", "M_lr/M_target", "second", "bound", "b/a", "c/a"]


def write_comparison(campaign_directory: Path) -> tuple[xr.Dataset, str, list[Path]]:
    """Write comparison.png and comparison.md into a campaign's directory.

    Returns:
        The results of its jobs, the text of comparison.md, and the files.

    Raises:
        SceneError: the campaign has no dimension case or seed, or no run of it is done.
    """
    results = collect(campaign_directory)
    rows = compared(results)
    text = markdown(rows)
    files = [campaign_directory / f"comparison.{kind}" for kind in ("png", "md")]
    save(beside_other_methods(rows), files[0])
    write_text(files[1], text)
    return results, text, files


def markdown(rows: pd.DataFrame) -> str:
    """Return one table for each collision.

    Args:
        rows: of all methods.
    """
    parts = [
        f"{velocity:g} m/s, {angle:g} deg\n\n{_table(group)}"
        for (velocity, angle), group in rows.groupby(COLLISION, sort=False)
    ]
    return "\n\n".join(parts) + "\n"


def _table(group: pd.DataFrame) -> str:
    lines = []
    for _, row in group.iterrows():
        settled = ", settled" if row.get("settled") == "yes" else ""
        size = f"2 x {row['particles']:,.0f}" if row["particles"] == row["particles"] else ""
        time = f"{row['time']:,.0f}{settled}" if row["time"] == row["time"] else settled.removeprefix(", ")
        runs = f"{row['runs']:.0f}" if row["runs"] == row["runs"] else ""
        method = label(row["method"], row["material"])
        lines.append([method, size, runs, time, *(_number(row, name) for name in MEASURED)])
    return markdown_table(HEADS, lines)


def _number(row: pd.Series, name: str) -> str:
    """Value, and its standard deviation where several seeds have one."""
    if row[name] != row[name]:
        return ""
    spread = row.get(f"{name}_spread", float("nan"))
    return f"{row[name]:.2f}" + (f" +- {spread:.2f}" if spread == spread else "")
