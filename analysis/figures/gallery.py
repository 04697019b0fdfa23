"""The largest remnant of every cell, all at one scale."""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import pyplot as plt
from matplotlib.patches import Rectangle

from analysis.figures.style import GREY, Directories, nothing_done
from analysis.figures.views import Frame, Views, frame_around, views_of
from analysis.tables import series
from engine.jobdir import JobDirectory

WRAP = 4
"""Pictures in a row when the cells are no full grid of velocity and angle."""


def gallery(results: xr.Dataset, directories: Directories) -> Any:
    """One picture a cell at a common scale; of several seeds the first.

    Args:
        results: the results of a campaign.
        directories: job directory of each job id.
    """
    groups = [rows.assign(series=title).drop_duplicates(["velocity", "angle"]) for title, rows in series(results)]
    shown = pd.concat(groups)
    done = shown.loc[shown["state"] == "done", "job"]
    if done.empty:
        return nothing_done()
    views = dict(zip(done, views_of([JobDirectory(directories[job]).final for job in done]), strict=True))
    frame = frame_around(list(views.values()))
    figure, panels = _grid(len(shown), _columns(shown), frame)
    for axes, (_, cell) in zip(panels, shown.iterrows(), strict=False):
        _panel(axes, cell, views.get(cell["job"]), frame)
    _scale_bar(panels[-_columns(shown)], frame)
    return figure


def _columns(shown: pd.DataFrame) -> int:
    """The number of angles when every velocity has them all."""
    angles = shown["angle"].nunique()
    full = len(shown) == angles * len(shown[["series", "velocity"]].drop_duplicates())
    return angles if full and angles > 1 else min(WRAP, len(shown))


def _grid(count: int, columns: int, frame: Frame) -> tuple[Any, Any]:
    """A figure with room for `count` panels, each as wide as the frame and as high as both views and their captions."""
    rows = -(-count // columns)
    width = 2.5 if columns <= WRAP else 1.6
    height = width * (frame.flat + frame.edge) / frame.width + 0.5
    figure, panels = plt.subplots(rows, columns, figsize=(width * columns, height * rows), squeeze=False)
    figure.subplots_adjust(left=0.0, right=1.0, bottom=0.0, top=1.0, wspace=0.06, hspace=0.5 / height)
    for axes in panels.ravel():
        axes.set_axis_off()
        axes.set(xlim=(-frame.width, frame.width), ylim=(-frame.flat - 2.0 * frame.edge, frame.flat), aspect="equal")
    return figure, panels.ravel()


def _panel(axes: Any, cell: pd.Series, views: Views | None, frame: Frame) -> None:
    axes.set_title(_caption(cell), fontsize=7.5, pad=3)
    if views is None:
        box = Rectangle((0, 0), 1, 1, transform=axes.transAxes, hatch="////", facecolor="white", edgecolor="#dddddd")
        axes.add_patch(box)
        axes.text(
            0.5,
            0.5,
            cell["state"],
            transform=axes.transAxes,
            ha="center",
            va="center",
            color=GREY,
            backgroundcolor="white",
        )
        return
    for found, centre in ((views.flat, 0.0), (views.edge, -frame.flat - frame.edge)):
        left, right, bottom, top = found.extent
        axes.imshow(found.pixels, extent=(left, right, bottom + centre, top + centre), origin="lower", clip_on=False)
    axes.set(xlim=(-frame.width, frame.width), ylim=(-frame.flat - 2.0 * frame.edge, frame.flat))


def _caption(cell: pd.Series) -> str:
    place = f"{cell['velocity']:g} m/s, {cell['angle']:g}°" + (f", {cell['series']}" if cell["series"] else "")
    if cell["state"] != "done":
        return place
    return f"{place}\n$M$ {cell['mass_ratio']:.2f}   $b/a$ {cell['b_over_a']:.2f}   $c/a$ {cell['c_over_a']:.2f}"


def _scale_bar(axes: Any, frame: Frame) -> None:
    """A bar of a round length below a panel."""
    length = 10.0 ** np.floor(np.log10(frame.width))
    left, low = -frame.width, -frame.flat - 2.0 * frame.edge
    axes.plot([left, left + length], [low, low], color="black", linewidth=2.0, clip_on=False, solid_capstyle="butt")
    axes.annotate(
        f"{length / 1000.0:g} km", (left, low), (0, -4), textcoords="offset points", va="top", annotation_clip=False
    )
