"""Shape of the largest remnant against impact angle, one line per velocity."""

from typing import Any

import pandas as pd
import xarray as xr
from matplotlib import pyplot as plt
from matplotlib.lines import Line2D

from analysis.figures.style import GREY, MARKERS, nothing_done, velocity_colours
from analysis.tables import cells, series

PANELS = {"b_over_a": "$b/a$", "c_over_a": "$c/a$"}


def shape_versus_angle(results: xr.Dataset) -> Any:
    """b/a and c/a against angle, mean and standard deviation over seeds; thin remnants hollow."""
    if not (results["state"] == "done").any():
        return nothing_done()
    figure, panels = plt.subplots(1, 2, figsize=(7.6, 3.5), sharey=True, layout="constrained")
    colours = velocity_colours(cells(results)["velocity"].dropna())
    for (name, label), axes in zip(PANELS.items(), panels, strict=True):
        for number, (title, table) in enumerate(series(results)):
            for velocity, rows in table.groupby("velocity"):
                text = f"{velocity:g} m/s" + (f", {title}" if title else "")
                _line(
                    axes,
                    rows,
                    name,
                    {"color": colours[float(str(velocity))], "marker": MARKERS[number % len(MARKERS)], "label": text},
                )
        axes.set(title=label, xlabel="impact angle [deg]", ylim=(0.0, 1.03))
        axes.margins(x=0.06)
        axes.grid(axis="y", color="#e6e6e6", linewidth=0.7)
        axes.set_axisbelow(True)
    panels[0].set_ylabel("axis ratio of the largest remnant")
    _legend(figure, panels[0])
    return figure


def _line(axes: Any, rows: pd.DataFrame, name: str, look: dict[str, Any]) -> None:
    found = rows.groupby("angle").agg(mean=(name, "mean"), spread=(name, "std"), thin=("largest_thin", "max"))
    axes.errorbar(found.index, found["mean"], found["spread"].fillna(0.0), capsize=2.5, elinewidth=0.9, **look)
    thin = found[found["thin"] > 0.0]
    hollow = look | {"label": None, "linestyle": "none", "markerfacecolor": "white", "zorder": 5}
    axes.plot(thin.index, thin["mean"], **hollow)


def _legend(figure: Any, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    hollow = Line2D([], [], linestyle="none", marker="o", color=GREY, markerfacecolor="white")
    handles, labels = [*handles, hollow], [*labels, "thin: $c < 4h$"]
    figure.legend(handles, labels, loc="outside right center", title="velocity at contact", title_fontsize=8)
