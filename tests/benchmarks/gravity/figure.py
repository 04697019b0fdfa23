"""Error against time, one panel a state."""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STYLES = {"this project": "C0", "pytreegrav": "C1", "rebound": "C2"}
TARGET = 0.5
"""Error [%] that the default opening must keep."""


def draw(curves: dict[str, list[dict[str, Any]]], path: Path) -> None:
    """Write the figure of the curves of every state."""
    figure, panels = plt.subplots(1, len(curves), figsize=(9.0, 3.6), sharey=True, layout="constrained")
    for panel, (state, lines) in zip(panels, curves.items(), strict=True):
        for line in lines:
            _draw_line(panel, line)
        panel.axhline(TARGET, color="0.6", linewidth=0.8)
        panel.set(title=state, xscale="log", yscale="log", xlabel="CPU time of one evaluation [ms]")
    panels[0].set_ylabel("99th percentile of |da|/|a| [%]")
    panels[-1].legend(fontsize="small")
    figure.savefig(path, dpi=110)


def _draw_line(panel: Any, line: dict[str, Any]) -> None:
    expansion, style = ("quadrupole", "o-") if line["quadrupole"] else ("monopole", "o--")
    times = [row["cpu_ms"] for row in line["rows"]]
    errors = [100.0 * row["percentile_99"] for row in line["rows"]]
    color = STYLES[line["code"]]
    panel.plot(times, errors, style, color=color, markersize=3, linewidth=1, label=f"{line['code']}, {expansion}")
