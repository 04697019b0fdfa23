"""One look for all figures: fonts, sizes, and colours that colour-blind readers can tell apart."""

from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import ParamSpec, Protocol

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from analysis.remnant.outcome import Outcomes
from engine.job.storage import write_atomically

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#666666"
"""Okabe & Ito (2008)."""


class Drawing(Protocol):
    """A module that draws one figure of a campaign.

    Attributes:
        NAME: stem of its file in figures/.
        CAPTION: what it shows, in one sentence.
    """

    NAME: str
    CAPTION: str

    def draw(self, results: xr.Dataset, outcomes: Outcomes) -> Figure:
        """Draw the figure.

        Args:
            results: the results of a campaign.
            outcomes: of its jobs, by job id.
        """


MARKERS = "osD^vP*X"

SYMBOLS = {"mass_ratio": r"$M_\mathrm{lr}\,/\,M_\mathrm{target}$", "b_over_a": "$b/a$", "c_over_a": "$c/a$"}
"""Of outcomes, in figures."""

STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.labelsize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "axes.edgecolor": "#333333",
    "axes.grid": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "lines.markersize": 5.5,
    "figure.dpi": 150,
    "savefig.dpi": 150,
    "hatch.linewidth": 0.5,
}
"""Settings of matplotlib in force while a figure is drawn and written, and only then."""

Arguments = ParamSpec("Arguments")
Colour = tuple[float, float, float, float]
"""Red, green, blue and opacity, 0 to 1."""


def styled(draw: Callable[Arguments, Figure]) -> Callable[Arguments, Figure]:
    """Let a function draw in `STYLE`; the settings of the caller stay as they are."""

    @wraps(draw)
    def drawn(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Figure:
        with matplotlib.rc_context(STYLE):
            return draw(*args, **kwargs)

    return drawn


def shades(levels: Iterable[float]) -> dict[float, Colour]:
    """A colour for each level, dark for low and light for high."""
    levels = sorted({float(level) for level in levels})
    colours = (matplotlib.colormaps["viridis"](position) for position in np.linspace(0.0, 0.88, len(levels)))
    return dict(zip(levels, colours, strict=True))


@styled
def nothing_done() -> Figure:
    """A figure that shows only why it is empty."""
    figure = Figure(figsize=(6.0, 2.0))
    axes = figure.subplots()
    axes.set(xticks=[], yticks=[])
    axes.spines[:].set(visible=True, color="#cccccc")
    axes.text(0.5, 0.5, "no job of this campaign is done yet", ha="center", va="center", color=GREY, fontsize=11)
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write a figure as PNG."""
    with matplotlib.rc_context(STYLE):
        write_atomically(
            path, lambda partial: figure.savefig(partial, format="png", bbox_inches="tight", pad_inches=0.12)
        )
