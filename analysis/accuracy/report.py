"""The tables of accuracy in Markdown, and the files of a campaign's accuracy."""

from collections.abc import Iterable
from pathlib import Path

import xarray as xr

from analysis.accuracy.cases import cases
from analysis.accuracy.figure import error_against_cost
from analysis.accuracy.measure import MEASURED, accuracy
from analysis.remnant.variables import DRIFTS
from analysis.report.figures.style import save
from analysis.results.collect import collect
from analysis.results.tables import markdown_table
from campaigns.campaign import KeptCampaign, read_campaign
from engine.errors import SceneError
from engine.job.directory import JobState
from engine.job.storage import write_dataset, write_text

HEADS = {"mass_ratio": "M_lr/M_t", "b_over_a": "b/a", "c_over_a": "c/a", "bulk_density": "density [kg/m3]"}
DECIMALS = {"mass_ratio": 3, "b_over_a": 3, "c_over_a": 3, "bulk_density": 0}


def write_accuracy(campaign_directory: Path) -> tuple[xr.Dataset, str, list[Path]]:
    """Write accuracy.nc, accuracy.png and accuracy.md into a campaign's directory.

    Returns:
        The results of its jobs, the text of accuracy.md, and the files.

    Raises:
        SceneError: the campaign has other dimensions than case and seed, no case named base, or no finished run of it.
    """
    known = cases(read_campaign(campaign_directory, KeptCampaign))
    results = collect(campaign_directory)
    if not (results["state"].sel(case="base") == JobState.DONE).any():
        raise SceneError(f"{campaign_directory}: no run of the case 'base' is done yet; run the campaign first")
    data = accuracy(results, known)
    text = markdown(data, len(results["case"]))
    files = [campaign_directory / f"accuracy.{kind}" for kind in ("nc", "png", "md")]
    write_dataset(files[0], data)
    save(error_against_cost(data), files[1])
    write_text(files[2], text)
    return results, text, files


def markdown(data: xr.Dataset, planned: int) -> str:
    """Return the tables of values, differences to base and finest case, drifts, and observed orders.

    Args:
        data: accuracy of all cases.
        planned: number of cases of the campaign.
    """
    finest, left_out = data.attrs["finest"], planned - data.sizes["case"]
    missing = f" {left_out} cases of the study have no finished run and are left out." if left_out else ""
    bold = (
        "Seed by seed between cases of equal resolution, whose bodies are the same; else of the means. "
        "Bold is resolved, larger than its interval; the rest is not resolved."
    )
    parts = [
        f"Means over seeds +- half the width of their 95 % confidence interval.{missing}\n\n{_values(data)}",
        f"Difference to the base. {bold}\n\n{_changes(data, 'base')}",
        f"Difference to the finest case, {finest}. {bold}\n\n{_changes(data, 'finest')}",
        f"Size of the relative change of what is conserved, mean over seeds.\n\n{_drifts(data)}",
        "Observed orders in particle spacing, from one number of particles to the next; a dash where seeds do not "
        f"resolve both errors or no order fits. Drifts count from 0.\n\n{_orders(data)}",
    ]
    return "\n\n".join(parts) + "\n"


def _values(data: xr.Dataset) -> str:
    rows = [
        [
            name,
            f"{int(case['runs'])}",
            *(_number(case, key) for key in MEASURED),
            f"{float(case['steps']):,.0f}",
            f"{float(case['cpu_time']):.0f}",
        ]
        for name, case in _each(data)
    ]
    return markdown_table(["case", "runs", *HEADS.values(), "steps", "CPU time [s]"], rows)


def _changes(data: xr.Dataset, role: str) -> str:
    rows = [
        [name, *(_number(case, f"{key}_minus_{role}", DECIMALS[key], "+") for key in MEASURED)]
        for name, case in _each(data)
        if case[f"mass_ratio_minus_{role}"].notnull()
    ]
    return markdown_table(["case", *HEADS.values()], rows)


def _drifts(data: xr.Dataset) -> str:
    rows = [[name, *(f"{float(case[key]):.2g}" for key in DRIFTS)] for name, case in _each(data)]
    return markdown_table(["case", "mass", "momentum", "angular momentum", "energy"], rows)


def _orders(data: xr.Dataset) -> str:
    names = [str(name) for name in data if str(name).startswith("order_")]
    heads = [name.removeprefix("order_").replace("_", " ") for name in names]
    rows = [
        [str(step), *(_plain(float(data[name].sel(refinement=step)), 1) for name in names)]
        for step in data["refinement"].values
    ]
    return markdown_table(["particles", *heads], rows)


def _each(data: xr.Dataset) -> Iterable[tuple[str, xr.Dataset]]:
    return ((str(name), data.sel(case=name)) for name in data["case"].values)


def _number(case: xr.Dataset, name: str, decimals: int | None = None, sign: str = "") -> str:
    """Value +- interval, bold where it is resolved."""
    decimals = DECIMALS[name] if decimals is None else decimals
    value, half = float(case[name]), float(case[f"{name}_interval"])
    text = f"{value:{sign},.{decimals}f}" + (f" +- {half:.{decimals}f}" if half == half else "")
    return f"**{text}**" if f"{name}_resolved" in case and float(case[f"{name}_resolved"]) == 1.0 else text


def _plain(value: float, decimals: int) -> str:
    return f"{value:.{decimals}f}" if value == value else "-"
