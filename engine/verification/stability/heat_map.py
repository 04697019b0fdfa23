"""The figure of all cases: groups as rows, their cases within, coloured by how they ended."""

from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

CASE_SIZE = (1.0, 0.55)
"""Width and height of the rectangle of a case [inch]."""

LETTERS = 14
"""Letters of a name that fit into the width of a rectangle."""

COLORS = {"stopped": "tab:orange", "failed": "tab:red", "energy not known": "0.8"}

MAP, LOSS = colormaps["YlGnBu"], Normalize(0.0, 1.0)


def draw(cases: pd.DataFrame) -> Figure:
    """Draw a rectangle for each case: a stable one is coloured by its dissipation, others by their verdict.

    Args:
        cases: one row a case, with `group`, `name`, `verdict` and `dissipation`.
    """
    groups = list(cases["group"].unique())
    columns = int(cases.groupby("group").size().max())
    size = (CASE_SIZE[0] * columns + 2.2, CASE_SIZE[1] * len(groups) + 0.8)
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots()
    for row, group in enumerate(groups):
        members = cases[cases["group"] == group]
        looks = zip(members["name"], members["verdict"], members["dissipation"], strict=True)
        for column, (name, verdict, dissipation) in enumerate(looks):
            _rectangle(axes, (column, row), str(name), _color(verdict, dissipation))
    axes.set(xlim=(0, columns), ylim=(len(groups), 0), xticks=[])
    axes.set_yticks(np.arange(len(groups)) + 0.5, groups)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    _legends(figure, axes)
    return figure


def _legends(figure: Figure, axes: Axes) -> None:
    """The scale of dissipation, and the colours of the verdicts."""
    label = "stable: energy lost from start to end, over the sum of all energies"
    figure.colorbar(ScalarMappable(LOSS, MAP), ax=axes, label=label, aspect=40, pad=0.01)
    patches = [Patch(color=color, label=name) for name, color in COLORS.items()]
    axes.legend(handles=patches, loc="lower right", ncols=len(patches))


def _rectangle(axes: Axes, corner: tuple[int, int], name: str, color: tuple[float, float, float]) -> None:
    red, green, blue = color
    axes.add_patch(Rectangle(corner, 1, 1, facecolor=color, edgecolor="white", lw=2.0))
    # perceived brightness
    ink = "white" if 0.3 * red + 0.6 * green + 0.1 * blue < 0.5 else "black"
    text = fill(name, LETTERS, break_on_hyphens=False)
    axes.text(corner[0] + 0.5, corner[1] + 0.5, text, ha="center", va="center", size=7.5, color=ink)


def _color(verdict: str, dissipation: float) -> tuple[float, float, float]:
    if verdict in COLORS:
        return to_rgb(COLORS[verdict])
    if np.isnan(dissipation):
        return to_rgb(COLORS["energy not known"])
    return to_rgb(MAP(LOSS(dissipation)))
