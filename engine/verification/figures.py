"""Figures of verification problems that show more than numbers."""

from collections.abc import Iterable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from engine.verification.bar import CONTINUUM_PEAK, Bar, Pull
from engine.verification.check import Problem
from engine.verification.cliff import Cliff, experiment, jutzi


def draw(problems: Iterable[Problem], directory: Path) -> None:
    """Write one PNG for each problem that has a figure."""
    directory.mkdir(parents=True, exist_ok=True)
    for problem in problems:
        figure, axes = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
        if isinstance(problem, Bar):
            _bar(axes, problem)
        elif isinstance(problem, Cliff):
            _cliff(axes, problem)
        if axes.has_data():
            figure.savefig(directory / f"{problem.name}.png", dpi=150)
        plt.close(figure)


def _bar(axes: Axes, problem: Bar) -> None:
    """Peak stress over strain rate."""
    rates = np.array(problem.rates)
    axes.loglog(rates, CONTINUUM_PEAK * rates**0.25, "--", color="0.5", label="continuum law, rate$^{1/4}$")
    axes.loglog(rates, [Pull(rate).reference().max() for rate in rates], "-", label="NumPy, the same flaws")
    axes.loglog(rates, [Pull(rate).engine().max() for rate in rates], "o", label="engine")
    axes.set(xlabel="strain rate [1/s]", ylabel="peak stress [Pa]")
    axes.legend()


def _cliff(axes: Axes, problem: Cliff) -> None:
    """Surface of the collapsed cliff."""
    for number, (when, moment) in enumerate(problem.run().items()):
        color, band, sph = f"C{number}", experiment(when), jutzi(when)
        axes.fill_between(*band.T, color=color, alpha=0.25, lw=0.0, label=f"{when}: experiments (Lajeunesse 2005)")
        axes.plot(*sph.T, "--", color=color, label=f"{when}: SPH (Jutzi 2015)")
        axes.step(*problem.profile(moment), where="mid", color=color, label=f"{when}: engine")
    axes.set(xlabel="$L/L_0$", ylabel="$H/L_0$", xlim=(0.0, 8.0))
    axes.legend()
