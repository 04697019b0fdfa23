"""Conservation: the energies of one job over time, the drifts of all."""

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from analysis.remnant.conservation import drifts, read_history
from analysis.remnant.outcome import Outcomes
from analysis.report.figures.style import BLUE, GREEN, GREY, ORANGE, PURPLE, nothing_done, shades, styled
from analysis.results.tables import points
from engine.job.directory import JobState
from engine.quantities import CONSERVED
from engine.scene.scene import scene_in

NAME = "conservation"
CAPTION = "Energies of one run, and drifts of the conserved quantities of all."

ENERGIES = {
    "kinetic_energy": ("kinetic", BLUE),
    "affine_kinetic_energy": ("kinetic, affine part", PURPLE),
    "internal_energy": ("internal", ORANGE),
    "transfer_heat": ("of it heat of the transfer", GREY),
    "gravitational_energy": ("gravitational", GREEN),
    "total_energy": ("total", "black"),
}
SMALLEST = 1e-17
"""Lower end of the drifts that are drawn: smaller ones are round-off."""


@styled
def draw(results: xr.Dataset, outcomes: Outcomes) -> Figure:
    """Draw the energies of the first job that is done, and the drifts of all of them, over time.

    Args:
        results: the results of a campaign.
        outcomes: of its jobs, by job id.
    """
    table = points(results)
    done = table[table["state"] == JobState.DONE]
    if done.empty:
        return nothing_done()
    figure = Figure(figsize=(10.4, 4.6), layout="constrained")
    left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1.0, 1.6))[0]
    first = done.iloc[0]
    _energies(left, read_history(outcomes[first["job"]].job.history), first)
    _drifts(right, done, outcomes)
    return figure


def _energies(figure: SubFigure, history: xr.Dataset, point: pd.Series) -> None:
    axes = figure.subplots()
    start = float(history["kinetic_energy"][0])
    for name, (label, colour) in ENERGIES.items():
        axes.plot(history["time"] / 1000.0, history[name] / start, color=colour, label=label)
    axes.axhline(0.0, color="#cccccc", linewidth=0.7, zorder=0)
    axes.set(title=f"energies at {point['velocity']:g} m/s, {point['angle']:g}°")
    axes.set(xlabel="time after contact [1000 s]", ylabel="energy / kinetic energy at the start")
    figure.legend(loc="outside lower center", ncols=3)


def _drifts(figure: SubFigure, done: pd.DataFrame, outcomes: Outcomes) -> None:
    panels = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    colours = shades(done["velocity"])
    for _, point in done.iterrows():
        job = outcomes[point["job"]].job
        changes = drifts(read_history(job.history), scene_in(job.path)).isel(time=slice(1, None))
        for axes, name in zip(panels, CONSERVED, strict=True):
            size = np.maximum(np.abs(changes[name]), SMALLEST)
            axes.plot(changes["time"] / 1000.0, size, color=colours[point["velocity"]], linewidth=0.9, alpha=0.8)
    for axes, name in zip(panels, CONSERVED, strict=True):
        axes.set(title=name.replace("_", " "), yscale="log")
    figure.supylabel("size of the relative change since the start", fontsize=9)
    figure.supxlabel("time after contact [1000 s]", fontsize=9)
    lines = [Line2D([], [], color=colour, label=f"{velocity:g} m/s") for velocity, colour in colours.items()]
    figure.legend(handles=lines, loc="outside right center")
