"""Outcomes over velocity and angle as heat maps."""

from textwrap import fill

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from analysis.remnant.outcome import Outcomes
from analysis.report.figures.style import GREY, SYMBOLS, styled
from analysis.results.tables import series
from engine.job.directory import JobState

NAME = "maps"
CAPTION = "Mass and axis ratios of the largest remnant over velocity and angle."

PANELS = {
    "mass_ratio": (SYMBOLS["mass_ratio"], 2.0),
    "b_over_a": (SYMBOLS["b_over_a"], 1.0),
    "c_over_a": (SYMBOLS["c_over_a"], 1.0),
}
"""Title and upper end of the colour scale of each map."""


LETTERS = 28
"""Letters of a row's label in a line."""


@styled
def draw(results: xr.Dataset, outcomes: Outcomes) -> Figure:
    """M_lr/M_target, b/a and c/a, one row of maps per series; means over seeds, missing points with their state."""
    groups = list(series(results))
    tallest, widest = (max(rows[name].nunique() for _, rows in groups) for name in ("velocity", "angle"))
    size = (3 * max(2.4, 0.42 * widest + 1.0), len(groups) * max(2.2, 0.36 * tallest + 1.0))
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(len(groups), 3, squeeze=False)
    for row, (title, table) in zip(panels, groups, strict=True):
        for axes, (name, (_, highest)) in zip(row, PANELS.items(), strict=True):
            _map(axes, table, name, highest)
        row[0].set_ylabel(f"{fill(title, LETTERS)}\nvelocity at contact [m/s]".strip())
    for top, bottom, (label, _) in zip(panels[0], panels[-1], PANELS.values(), strict=True):
        top.set_title(label)
        bottom.set_xlabel("impact angle [deg]")
    return figure


def _map(axes: Axes, table: pd.DataFrame, name: str, highest: float) -> None:
    values = table.pivot_table(index="velocity", columns="angle", values=name, aggfunc="mean", dropna=False)
    states = table.pivot_table(index="velocity", columns="angle", values="state", aggfunc=_least_done, dropna=False)
    states = states.reindex(index=values.index, columns=values.columns)
    colours = colormaps["cividis"]
    axes.imshow(values.to_numpy(float), cmap=colours, vmin=0.0, vmax=highest, aspect="auto", origin="lower")
    for (row, column), value in np.ndenumerate(values.to_numpy(float)):
        if np.isfinite(value):
            ink = "white" if value < 0.55 * highest else "black"
            axes.text(column, row, f"{value:.2f}", ha="center", va="center", color=ink, fontsize=7.5)
        else:
            _missing(axes, column, row, states.iloc[row, column])
    axes.set_xticks(range(values.shape[1]), [f"{angle:g}" for angle in values.columns])
    axes.set_yticks(range(values.shape[0]), [f"{velocity:g}" for velocity in values.index])
    axes.set_xticks(np.arange(0.5, values.shape[1] - 1), minor=True)
    axes.set_yticks(np.arange(0.5, values.shape[0] - 1), minor=True)
    axes.grid(which="minor", color="white", linewidth=1.2)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)


def _missing(axes: Axes, column: int, row: int, state: object) -> None:
    """A hatched point with the state of its job; an empty one where the study has no job."""
    if not isinstance(state, str):
        return
    box = Rectangle(
        (column - 0.5, row - 0.5), 1.0, 1.0, hatch="////", facecolor="white", edgecolor="#cccccc", linewidth=0
    )
    axes.add_patch(box)
    halo = [withStroke(linewidth=2.5, foreground="white")]
    axes.text(column, row, state, ha="center", va="center", color=GREY, fontsize=5.5, path_effects=halo)


def _least_done(states: pd.Series) -> str:
    """The first state that is not done, since a point without a number has none done."""
    return next((str(state) for state in states if state != JobState.DONE), JobState.DONE)
