"""Shape of the largest remnant against impact angle, one line per velocity and series."""

from collections.abc import Iterator
from itertools import cycle
from typing import TypedDict

import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from analysis.remnant.outcome import Outcomes
from analysis.report.figures.style import GREY, MARKERS, Colour, nothing_done, shades, styled
from analysis.results.tables import points, series
from engine.job.directory import JobState

NAME = "shape_vs_angle"
CAPTION = "Axis ratios of the largest remnant against impact angle."

DASHES = ("-", "--", ":", "-.")

PANELS = {"b_over_a": "$b/a$", "c_over_a": "$c/a$"}


class Look(TypedDict):
    """How a line is drawn."""

    color: Colour
    marker: str
    linestyle: str


@styled
def draw(results: xr.Dataset, outcomes: Outcomes) -> Figure:
    """b/a and c/a against angle, thin remnants hollow.

    Bars are the errors of a study with error bars, else, over an axis of seeds, the standard deviation of one run.
    """
    if not (results["state"] == JobState.DONE).any():
        return nothing_done()
    figure = Figure(figsize=(7.8, 3.5), layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    looks = dict(_lines(results))
    for (name, title), axes in zip(PANELS.items(), panels, strict=True):
        for look, rows in looks.values():
            _line(axes, rows, name, look)
        axes.set(title=title, xlabel="impact angle [deg]", ylim=(0.0, 1.03))
        axes.xaxis.set_major_locator(MaxNLocator(10, steps=[1, 5, 10]))
        axes.margins(x=0.06)
        axes.grid(axis="y", color="#e6e6e6", linewidth=0.7)
        axes.set_axisbelow(True)
    panels[0].set_ylabel("axis ratio of the largest remnant")
    handles = [Line2D([], [], label=label, **look) for label, (look, _) in looks.items()]
    hollow = Line2D([], [], linestyle="none", marker="o", color=GREY, markerfacecolor="white", label="thin: $c < 4h$")
    figure.legend(handles=[*handles, hollow], loc="outside right center")
    return figure


def _lines(results: xr.Dataset) -> Iterator[tuple[str, tuple[Look, pd.DataFrame]]]:
    """Label, look and points of each line: colour and marker tell the velocity, or, where there is one, the series."""
    groups, velocities = list(series(results)), points(results)["velocity"].dropna().unique()
    by_velocity = len(velocities) > 1
    colours = shades(velocities if by_velocity else range(len(groups)))
    markers = dict(zip(colours, cycle(MARKERS), strict=False))
    for number, ((title, table), dashes) in enumerate(zip(groups, cycle(DASHES), strict=False)):
        for speed, rows in table.groupby("velocity"):
            velocity = float(str(speed))
            level = velocity if by_velocity else float(number)
            look = Look(color=colours[level], marker=markers[level], linestyle=dashes)
            yield f"{velocity:g} m/s" + (f", {title}" if title else ""), (look, rows)


def _line(axes: Axes, rows: pd.DataFrame, name: str, look: Look) -> None:
    spread = (f"{name}_error", "mean") if f"{name}_error" in rows else (name, "std")
    found = rows.groupby("angle").agg(mean=(name, "mean"), spread=spread, thin=("c_unresolved", "max"))
    bars = found["spread"].fillna(0.0)
    axes.errorbar(found.index, found["mean"], bars, capsize=2.5, elinewidth=0.9, markeredgewidth=1.2, **look)
    thin = found[found["thin"] > 0.0]
    hollow = Look(color=look["color"], marker=look["marker"], linestyle="none")
    axes.plot(thin.index, thin["mean"], markeredgewidth=1.2, markerfacecolor="white", zorder=5, **hollow)
