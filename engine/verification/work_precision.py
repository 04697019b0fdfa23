"""The figure of error against CPU time."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import pandas as pd
from matplotlib.axes import Axes

from engine.verification.knobs import TRADEOFFS
from engine.verification.pareto import pareto

COLUMNS = 4


def draw(runs: pd.DataFrame, path: Path) -> None:
    """One panel a scene, one line a knob; a dashed line joins the runs that no other beats in both."""
    scenes = [name for name in TRADEOFFS if (runs["scene"] == name).any()]
    rows = -(-len(scenes) // COLUMNS)
    figure, panels = plt.subplots(
        rows, COLUMNS, figsize=(3.2 * COLUMNS, 2.9 * rows), layout="constrained", squeeze=False
    )
    for axes, name in zip(panels.flat, scenes, strict=False):
        _panel(axes, runs[runs["scene"] == name], name)
    for axes in panels.flat[len(scenes) :]:
        axes.set_axis_off()
    knobs = {line.get_label(): line for axes in panels.flat for line in axes.get_lines()}
    figure.legend(knobs.values(), knobs.keys(), loc="outside lower center", ncols=COLUMNS)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def _panel(axes: Axes, runs: pd.DataFrame, name: str) -> None:
    for knob, group in runs.groupby("knob", sort=True):
        ordered = group.assign(number=group["value"].astype(float)).sort_values("number")
        axes.loglog(ordered["cpu_time"], ordered["error"], ".-", color=_color(str(knob)), label=str(knob))
    front = pareto(runs)
    axes.loglog(front["cpu_time"], front["error"], "--", color="0.4", lw=2.5, zorder=0, label="no run beats these")
    axes.set_title(f"{name}: {TRADEOFFS[name].quantity}", fontsize=7)
    axes.set(xlabel="CPU time [s]", ylabel="error")


def _color(knob: str) -> str:
    """The same for every scene; all resolutions share one."""
    names = sorted({key for tradeoff in TRADEOFFS.values() for key in tradeoff.knobs})
    return f"C{names.index(knob) + 1}" if knob in names else "C0"
