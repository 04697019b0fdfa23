"""What the runs conserved: the energy ledger of one, the drifts of all."""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib import pyplot as plt

from analysis.figures.style import BLUE, GREEN, GREY, ORANGE, PURPLE, Directories, nothing_done, velocity_colours
from analysis.ledger import drifts, read_history
from analysis.tables import cells
from engine.jobdir import JobDirectory
from engine.scene import scene_in

LEDGER = {
    "kinetic_energy": ("kinetic", BLUE),
    "affine_kinetic_energy": ("kinetic, affine part", PURPLE),
    "internal_energy": ("internal", ORANGE),
    "gravitational_energy": ("gravitational", GREEN),
    "total_energy": ("total", "black"),
}
DRIFTS = {"mass": "mass", "momentum": "momentum", "angular_momentum": "angular momentum", "energy": "total energy"}
SMALLEST = 1e-17
"""Drifts are drawn from here up: below a unit in the last place there is none."""


def conservation(results: xr.Dataset, directories: Directories) -> Any:
    """The energy ledger of the first job that is done, and the drifts of all of them over time.

    Args:
        results: the results of a campaign.
        directories: job directory of each job id.
    """
    table = cells(results)
    done = table[table["state"] == "done"]
    if done.empty:
        return nothing_done()
    figure = plt.figure(figsize=(9.2, 4.4), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1.0, 1.35))
    first = done.iloc[0]
    _ledger(left.subplots(), read_history(JobDirectory(directories[first["job"]]).history), first)
    _drifts(right, done, directories)
    return figure


def _ledger(axes: Any, history: xr.Dataset, cell: pd.Series) -> None:
    start = float(history["kinetic_energy"][0])
    for name, (label, colour) in LEDGER.items():
        axes.plot(history["time"] / 1000.0, history[name] / start, color=colour, label=label)
    axes.axhline(0.0, color="#cccccc", linewidth=0.7, zorder=0)
    axes.set(title=f"energy, {cell['velocity']:g} m/s at {cell['angle']:g}°")
    axes.set(xlabel="time after contact [1000 s]", ylabel="energy / kinetic energy at the start")
    axes.legend(loc="best")


def _drifts(figure: Any, done: pd.DataFrame, directories: Directories) -> None:
    panels = figure.subplots(2, 2, sharex=True).ravel()
    colours = velocity_colours(done["velocity"])
    for _, cell in done.iterrows():
        job = JobDirectory(directories[cell["job"]])
        changes = drifts(read_history(job.history), scene_in(job.path))
        for axes, name in zip(panels, DRIFTS, strict=True):
            size = np.maximum(np.abs(changes[name]), SMALLEST)
            axes.plot(changes["time"] / 1000.0, size, color=colours[cell["velocity"]], linewidth=0.8)
    for axes, title in zip(panels, DRIFTS.values(), strict=True):
        axes.set(title=f"|change of {title}|, relative", yscale="log")
        axes.tick_params(color=GREY)
    for axes in panels[2:]:
        axes.set_xlabel("time after contact [1000 s]")
