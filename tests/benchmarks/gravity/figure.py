"""Error against time, one panel a state."""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

from engine.scene.scene import Gravity

COLORS = {"this project": "C0", "pytreegrav": "C1", "rebound": "C2"}
DEFAULTS = {("this project", True): Gravity().opening, ("pytreegrav", False): 0.7, ("rebound", False): 0.5}
"""Opening with which a code comes, and whether it then uses quadrupoles."""
TARGET = 0.5
"""Error [%] that the default opening must keep."""

Results = dict[str, Any]


def draw(curves: dict[str, list[Results]], path: Path) -> None:
    """Write the figure of the curves of every state."""
    figure, panels = plt.subplots(1, len(curves), figsize=(9.6, 4.6), sharex=True, sharey=True, layout="constrained")
    for panel, (state, lines) in zip(panels, curves.items(), strict=True):
        for line in lines:
            _draw_line(panel, line)
        panel.axhline(TARGET, color="0.5", linewidth=0.8, linestyle=":")
        panel.set(title=state, xscale="log", yscale="log", xlabel="CPU time of one evaluation, 1 thread [ms]")
        panel.grid(which="both", color="0.92", linewidth=0.6)
        panel.set_xticks([30, 100, 300, 1000, 3000])
        panel.set_yticks([0.01, 0.1, 1, 10])
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter("")
    panels[0].set_ylabel("99th percentile of |da|/|a| [%]")
    panels[0].text(0.02, TARGET, f"{TARGET} %", color="0.4", va="bottom", transform=panels[0].get_yaxis_transform())
    ring = {"color": "k", "marker": "o", "markersize": 10, "fillstyle": "none", "linestyle": "none"}
    default = Line2D([], [], label="defaults of a code", **ring)
    handles = [*panels[0].get_legend_handles_labels()[0], default]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize="small", frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _draw_line(panel: Any, line: Results) -> None:
    color, key = COLORS[line["code"]], (line["code"], line["quadrupole"])
    expansion, style = ("quadrupole", "o-") if line["quadrupole"] else ("monopole", "s--")
    points = {row["opening"]: (row["cpu_ms"], 100.0 * row["percentile_99"]) for row in line["rows"]}
    label = f"{line['code']}, {expansion}"
    panel.plot(*zip(*points.values(), strict=True), style, color=color, markersize=4, linewidth=1.2, label=label)
    if key in DEFAULTS:
        panel.plot(*points[DEFAULTS[key]], "o", color="k", markersize=10, fillstyle="none")
