"""The figure of mass and shape by method."""

from itertools import cycle

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.comparison.rows import COLLISION, OWN, label
from analysis.report.figures.style import BLUE, GREY, MARKERS, ORANGE, SYMBOLS, styled

Name = tuple[str, str]
"""Method and material."""

SIZE, FEWEST = 4.0, 1000.0
"""Size [pt] of a mark, and the particles of a body to which it belongs."""

TITLES = {
    "mass_ratio": SYMBOLS["mass_ratio"],
    "bound_mass_ratio": "bound mass$\\,/\\,M_\\mathrm{target}$",
    "b_over_a": SYMBOLS["b_over_a"],
    "c_over_a": SYMBOLS["c_over_a"],
}
"""Of the panels of a collision."""


@styled
def beside_other_methods(rows: pd.DataFrame) -> Figure:
    """Draw a row of panels for each collision: every method at its value, bars of one standard deviation over seeds.

    Marks grow with the number of particles.

    Args:
        rows: of all methods.
    """
    groups = list(rows.groupby(COLLISION, sort=False))
    names = list(dict.fromkeys(zip(rows["method"], rows["material"], strict=True)))
    looks = dict(zip(names, cycle(MARKERS), strict=False))
    figure = Figure(figsize=(8.2, 1.2 + 1.1 * len(groups)), layout="constrained")
    panels = figure.subplots(len(groups), len(TITLES), sharex="col", squeeze=False)
    for line, ((velocity, angle), group) in zip(panels, groups, strict=True):
        line[0].set_ylabel(f"{velocity:g} m/s\n{angle:g}$^\\circ$", rotation=0, ha="right", va="center")
        for axes, quantity in zip(line, TITLES, strict=True):
            _panel(axes, group, quantity, names, looks)
    for axes, title in zip(panels[0], TITLES.values(), strict=True):
        axes.set_title(title)
    handles = {
        text: handle for axes in panels.flat for handle, text in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=3)
    return figure


def _panel(axes: Axes, group: pd.DataFrame, quantity: str, names: list[Name], looks: dict[Name, str]) -> None:
    """One quantity of one collision; a method has the same height in all panels."""
    spreads = group.get(f"{quantity}_spread", pd.Series(index=group.index, dtype=float))
    for (_, row), spread in zip(group.iterrows(), spreads, strict=True):
        name = (row["method"], row["material"])
        own = row["method"] == OWN
        colour = BLUE if own else GREY if row["method"] == "scaling" else ORANGE
        axes.errorbar(
            row[quantity],
            -names.index(name),
            xerr=spread if spread == spread else None,
            marker=looks[name],
            markersize=SIZE * (row["particles"] / FEWEST) ** 0.12 if row["particles"] > 0.0 else SIZE,
            color=colour,
            markerfacecolor=colour if own else "white",
            linestyle="none",
            label=label(*name),
        )
    axes.set(ylim=(-len(names), 1), yticks=[])
