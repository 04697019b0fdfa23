"""The figure of error against CPU time."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine.verification.accuracy.log_axes import label_decades
from engine.verification.accuracy.pareto import pareto
from engine.verification.accuracy.settings import TRADEOFFS

COLUMNS = 4


def draw(runs: pd.DataFrame) -> Figure:
    """Draw a panel for each scene, with one line a setting and the Pareto front dashed.

    Args:
        runs: one row a run, with `scene`, `setting`, `value`, `error` and `cpu_time` [s].
    """
    scenes = [name for name in TRADEOFFS if (runs["scene"] == name).any()]
    rows = -(-len(scenes) // COLUMNS)
    figure = Figure(figsize=(3.2 * COLUMNS, 2.9 * rows), layout="constrained")
    panels = figure.subplots(rows, COLUMNS, squeeze=False)
    for axes, name in zip(panels.flat, scenes, strict=False):
        _panel(axes, runs[runs["scene"] == name], name)
    for axes in panels.flat[len(scenes) :]:
        axes.set_axis_off()
    lines = {line.get_label(): line for axes in panels.flat for line in axes.get_lines()}
    figure.legend(lines.values(), lines.keys(), loc="outside lower center", ncols=COLUMNS)
    return figure


def _panel(axes: Axes, runs: pd.DataFrame, name: str) -> None:
    axes.set(xscale="log", yscale="log")
    label_decades(axes.xaxis, runs["cpu_time"])
    label_decades(axes.yaxis, runs["error"])
    axes.tick_params(labelsize=7)
    for setting, group in runs.groupby("setting", sort=True):
        ordered = group.assign(number=pd.to_numeric(group["value"], errors="coerce")).sort_values("number")
        label = str(setting) if "." in str(setting) else "particles, cells or steps"
        axes.plot(ordered["cpu_time"], ordered["error"], ".-", color=_color(str(setting)), label=label)
    front = pareto(runs)
    axes.plot(front["cpu_time"], front["error"], "--", color="0.4", lw=2.5, zorder=0, label="no run beats these")
    axes.set_title(name, fontsize=9)
    axes.set_xlabel("CPU time [s]", fontsize=8)
    axes.set_ylabel(TRADEOFFS[name].quantity, fontsize=7)


def _color(setting: str) -> str:
    """Color of a setting, the same in every panel; all resolutions have the same."""
    names = sorted({key for tradeoff in TRADEOFFS.values() for key in tradeoff.settings})
    return f"C{names.index(setting) + 1}" if setting in names else "C0"
