"""The largest remnant of every point, all at one scale."""

from textwrap import fill

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from analysis.remnant.outcome import Outcomes
from analysis.report.figures.style import GREY, nothing_done, styled
from analysis.report.figures.views import Frame, Views, frame_around, views_of
from analysis.results.tables import series
from engine.job.directory import JobState

NAME = "remnants"
CAPTION = "The largest remnant of every collision, along its shortest axis and edge-on."

WIDE, NARROW, GAP, CAPTION_HEIGHT, LINE_HEIGHT = 2.5, 1.7, 0.1, 0.22, 0.12
"""Widths of a panel, space between panels, space for a caption, and for each of its lines [inch]."""

LETTERS = 19
"""Letters of a caption in an inch."""

KEY = (
    "Above: along the shortest axis; below: edge-on. Blue: target, orange: projectile. "
    "$M$: mass of the largest remnant over that of the target."
)

WRAP = 4
"""Pictures in a row when the points are no full grid of velocity and angle."""


@styled
def draw(results: xr.Dataset, outcomes: Outcomes) -> Figure:
    """One picture a point at a common scale; of several seeds the first.

    Args:
        results: the results of a campaign.
        outcomes: of its jobs, by job id.
    """
    groups = [rows.assign(series=title).drop_duplicates(["velocity", "angle"]) for title, rows in series(results)]
    shown = pd.concat(groups)
    done = shown.loc[shown["state"] == JobState.DONE, "job"]
    if done.empty:
        return nothing_done()
    views = dict(zip(done, views_of(outcomes[job].read_remnant() for job in done), strict=True))
    frame = frame_around(list(views.values()))
    columns = _columns(shown)
    width = NARROW if columns > WRAP and not shown["series"].any() else WIDE
    captions = [_caption(point, int(LETTERS * width)) for _, point in shown.iterrows()]
    lines = 1 + max(caption.count("\n") for caption in captions)
    figure, panels = _grid(len(shown), columns, width, CAPTION_HEIGHT + LINE_HEIGHT * lines, frame)
    for axes, caption, (_, point) in zip(panels, captions, shown.iterrows(), strict=False):
        axes.set_title(caption, fontsize=7.5, pad=3)
        _panel(axes, point, views.get(point["job"]), frame)
    _scale_bar(panels[-columns], 2.0 * frame.width, int(LETTERS * (width + GAP) * columns))
    return figure


def _columns(shown: pd.DataFrame) -> int:
    """The number of angles when every velocity has them all."""
    angles = shown["angle"].nunique()
    full = len(shown) == angles * len(shown[["series", "velocity"]].drop_duplicates())
    return angles if full and angles > 1 else min(WRAP, len(shown))


def _grid(count: int, columns: int, width: float, caption: float, frame: Frame) -> tuple[Figure, NDArray[np.object_]]:
    """A figure of panels `width` inches wide with room for captions, and its axes, shape [at least count]."""
    rows = -(-count // columns)
    height = width * (frame.flat + frame.edge) / frame.width
    size = (columns * width + (columns - 1) * GAP, rows * height + (rows - 1) * caption)
    figure = Figure(figsize=size)
    panels = figure.subplots(rows, columns, squeeze=False)
    figure.subplots_adjust(left=0.0, right=1.0, bottom=0.0, top=1.0, wspace=GAP / width, hspace=caption / height)
    for axes in panels.ravel():
        axes.set_axis_off()
    return figure, panels.ravel()


def _panel(axes: Axes, point: pd.Series, views: Views | None, frame: Frame) -> None:
    if views is None:
        _missing(axes, point["state"])
        return
    for found, centre in ((views.flat, 0.0), (views.edge, -frame.flat - frame.edge)):
        left, right, bottom, top = found.extent
        extent = (left, right, bottom + centre, top + centre)
        axes.imshow(found.pixels, extent=extent, origin="lower", interpolation="hanning")
    axes.set(xlim=(-frame.width, frame.width), ylim=(-frame.flat - 2.0 * frame.edge, frame.flat), aspect="auto")


def _missing(axes: Axes, state: str) -> None:
    whole = axes.transAxes
    axes.add_patch(Rectangle((0, 0), 1, 1, hatch="////", facecolor="white", edgecolor="#dddddd", transform=whole))
    axes.text(0.5, 0.5, state, ha="center", va="center", color=GREY, backgroundcolor="white", transform=whole)


def _caption(point: pd.Series, letters: int) -> str:
    text = f"{point['velocity']:g} m/s, {point['angle']:g}°" + (f", {point['series']}" if point["series"] else "")
    text = fill(text, letters)
    if point["state"] != JobState.DONE:
        return text
    return f"{text}\n$M$ {point['mass_ratio']:.2f}   $b/a$ {point['b_over_a']:.2f}   $c/a$ {point['c_over_a']:.2f}"


def _scale_bar(axes: Axes, width: float, letters: int) -> None:
    """A bar of a round length below a panel of the given width [m], and the key in lines of some letters."""
    power = 10.0 ** np.floor(np.log10(0.3 * width))
    length = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= 0.3 * width)
    (bar,) = axes.plot([0.0, length / width], [-0.02, -0.02], color="black", linewidth=2.0, solid_capstyle="butt")
    bar.set(transform=axes.transAxes, clip_on=False)
    axes.text(
        0.0, -0.06, fill(f"{length / 1000.0:g} km. {KEY}", letters), va="top", fontsize=7.5, transform=axes.transAxes
    )
