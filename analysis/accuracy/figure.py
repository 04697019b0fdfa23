"""The figure of error against CPU time."""

from itertools import cycle
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import colormaps
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analysis.accuracy.cases import SEVERAL
from analysis.accuracy.measure import MEASURED
from analysis.campaign import NONE
from analysis.report.figures.style import GREY, MARKERS, styled
from analysis.results.variables import OUTCOMES
from engine.verification.accuracy.log_axes import label_decades
from engine.verification.accuracy.pareto import pareto

HIDDEN = 0.05
"""Relative difference of errors below which two cases lie on top of each other."""

TITLES = {"mass_ratio": "$M_\\mathrm{lr}\\,/\\,M_\\mathrm{target}$", "b_over_a": "$b/a$", "c_over_a": "$c/a$"}


@styled
def error_against_cost(found: xr.Dataset) -> Figure:
    """One panel an outcome: error against CPU time of every case, those that no other beats joined.

    The error is the difference to the finest case; where seeds do not resolve it, the interval that hides it, drawn
    hollow.
    """
    figure = Figure(figsize=(8.2, 6.0), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True)
    found = found.assign_coords(knob=found["case"].where(found["knob"] == SEVERAL, found["knob"]))
    knobs = list(dict.fromkeys(str(knob) for knob in found["knob"].values))
    looks = dict(zip(knobs, zip(colormaps["tab10"](np.arange(10)), cycle(MARKERS), strict=False), strict=False))
    for axes, name in zip(panels.flat, MEASURED, strict=True):
        axes.set(xscale="log", yscale="log")
        _panel(axes, errors(found, name), looks)
        axes.set_title(TITLES.get(name, f"bulk density [{OUTCOMES[name].units}]"))
    figure.supxlabel("CPU time of a run [s]", fontsize=9)
    figure.supylabel(f"difference to {found.attrs['finest']}", fontsize=9)
    figure.legend(handles=_legend(looks), loc="outside right center")
    return figure


def errors(found: xr.Dataset, name: str) -> pd.DataFrame:
    """Case, knob, value, CPU time and error of one outcome; `resolved` where the error is a difference."""
    frame = found[[f"{name}_minus_finest", f"{name}_minus_finest_interval", "cpu_time"]].to_dataframe()
    frame = frame.dropna().rename(columns={f"{name}_minus_finest": "change", f"{name}_minus_finest_interval": "half"})
    error = np.maximum(frame["change"].abs(), frame["half"])
    return frame.assign(error=error, resolved=frame["change"].abs() > frame["half"])


def _panel(axes: Any, runs: pd.DataFrame, looks: dict[str, Any]) -> None:
    label_decades(axes.xaxis, runs["cpu_time"])
    label_decades(axes.yaxis, runs["error"])
    front = pareto(runs)
    axes.plot(front["cpu_time"], front["error"], "--", color=GREY, linewidth=1.0, zorder=1)
    for _, run in runs.iterrows():
        colour, marker = looks[run["knob"]]
        face = colour if run["resolved"] else "white"
        axes.plot(run["cpu_time"], run["error"], marker=marker, color=colour, markerfacecolor=face, linestyle="none")
        if label := _label(run, runs):
            axes.annotate(label, (run["cpu_time"], run["error"]), (3, 3), textcoords="offset points", fontsize=6.5)


def _label(run: pd.Series, runs: pd.DataFrame) -> str:
    """Value of the setting that is turned; nothing where it makes no visible difference to the base."""
    if run["knob"] == NONE:
        return "base"
    base = runs.loc[runs["knob"] == NONE, "error"]
    if not base.empty and abs(np.log(run["error"] / base.iloc[0])) < HIDDEN:
        return ""
    return "" if run["value"] == NONE else str(run["value"]).removesuffix(".0")


def _legend(looks: dict[str, Any]) -> list[Line2D]:
    handles = [
        Line2D([], [], color=colour, marker=marker, linestyle="none", label="base" if knob == NONE else knob)
        for knob, (colour, marker) in looks.items()
    ]
    hollow = Line2D([], [], color=GREY, marker="o", markerfacecolor="white", linestyle="none", label="not resolved")
    return [*handles, hollow, Line2D([], [], color=GREY, linestyle="--", linewidth=1.0, label="no case beats these")]
