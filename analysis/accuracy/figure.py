"""The figure of error against CPU time."""

from collections.abc import Iterable
from itertools import cycle

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from analysis.accuracy.cases import SEVERAL
from analysis.accuracy.measure import MEASURED
from analysis.remnant.variables import OUTCOMES
from analysis.report.figures.style import GREY, MARKERS, SYMBOLS, styled
from analysis.results.variables import NONE
from engine.verification.accuracy.log_axes import label_decades
from engine.verification.accuracy.pareto import pareto

Look = tuple[NDArray[np.float64], str]
"""Colour and marker."""

HIDDEN = 0.05
"""Relative difference of errors below which two cases lie on top of each other."""


@styled
def error_against_cost(data: xr.Dataset) -> Figure:
    """Draw a panel for each outcome: error against CPU time of every case, and the Pareto front dashed.

    The error is the difference to the finest case; where seeds do not resolve it, the interval that hides it, drawn
    hollow.
    """
    figure = Figure(figsize=(8.2, 6.0), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True)
    data = data.assign_coords(setting=data["case"].where(data["setting"] == SEVERAL, data["setting"]))
    looks = looks_of([str(setting) for setting in data["setting"].values])
    for axes, name in zip(panels.flat, MEASURED, strict=True):
        axes.set(xscale="log", yscale="log")
        _panel(axes, errors(data, name), looks)
        axes.set_title(SYMBOLS.get(name, f"bulk density [{OUTCOMES[name].units}]"))
    figure.supxlabel("CPU time of a run [s]", fontsize=9)
    figure.supylabel(f"difference to {data.attrs['finest']}", fontsize=9)
    figure.legend(handles=_legend(looks), loc="outside right center")
    return figure


def looks_of(settings: Iterable[str]) -> dict[str, Look]:
    """Return colour and marker of every setting; up to forty settings look different."""
    pairs = zip(cycle(colormaps["tab10"](np.arange(10))), cycle(MARKERS), strict=False)
    return dict(zip(dict.fromkeys(settings), pairs, strict=False))


def errors(data: xr.Dataset, name: str) -> pd.DataFrame:
    """Return case, setting, value, CPU time and error of one outcome; `resolved` where the error is a difference."""
    frame = data[[f"{name}_minus_finest", f"{name}_minus_finest_interval", "cpu_time"]].to_dataframe()
    frame = frame.dropna().rename(columns={f"{name}_minus_finest": "change", f"{name}_minus_finest_interval": "half"})
    error = np.maximum(frame["change"].abs(), frame["half"])
    return frame.assign(error=error, resolved=frame["change"].abs() > frame["half"])


def _panel(axes: Axes, runs: pd.DataFrame, looks: dict[str, Look]) -> None:
    label_decades(axes.xaxis, runs["cpu_time"])
    label_decades(axes.yaxis, runs["error"])
    front = pareto(runs)
    axes.plot(front["cpu_time"], front["error"], "--", color=GREY, linewidth=1.0, zorder=1)
    for _, run in runs.iterrows():
        colour, marker = looks[run["setting"]]
        face = colour if run["resolved"] else "white"
        axes.plot(run["cpu_time"], run["error"], marker=marker, color=colour, markerfacecolor=face, linestyle="none")
        if label := _label(run, runs):
            axes.annotate(label, (run["cpu_time"], run["error"]), (3, 3), textcoords="offset points", fontsize=6.5)


def _label(run: pd.Series, runs: pd.DataFrame) -> str:
    """Value of the setting that is varied; nothing where it makes no visible difference to the base."""
    if run["setting"] == NONE:
        return "base"
    base = runs.loc[runs["setting"] == NONE, "error"]
    if not base.empty and abs(np.log(run["error"] / base.iloc[0])) < HIDDEN:
        return ""
    return "" if run["value"] == NONE else str(run["value"]).removesuffix(".0")


def _legend(looks: dict[str, Look]) -> list[Line2D]:
    handles = [
        Line2D([], [], color=colour, marker=marker, linestyle="none", label="base" if setting == NONE else setting)
        for setting, (colour, marker) in looks.items()
    ]
    hollow = Line2D([], [], color=GREY, marker="o", markerfacecolor="white", linestyle="none", label="not resolved")
    return [*handles, hollow, Line2D([], [], color=GREY, linestyle="--", linewidth=1.0, label="no case beats these")]
