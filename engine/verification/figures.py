"""Figures of verification problems that show more than numbers."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from engine.verification.check import Problem
from engine.verification.harness import Harness
from engine.verification.problems.bar import CONTINUUM_PEAK, Bar, Pull
from engine.verification.problems.cliff import Cliff, experiment, jutzi

SIZES = (25, 50, 100, 200, 400, 800, 1600)
"""Particles in the bars that show how strength depends on resolution."""


def draw(problems: Iterable[Problem], directory: Path) -> None:
    """Write NAME.png for each problem that has a figure; its scenes run again."""
    directory.mkdir(parents=True, exist_ok=True)
    for problem in problems:
        if isinstance(problem, Bar):
            _bar(problem).savefig(directory / f"{problem.name}.png", dpi=110)
        elif isinstance(problem, Cliff):
            _cliff(problem).savefig(directory / f"{problem.name}.png", dpi=110)


def _bar(problem: Bar) -> Figure:
    """Peak stress over strain rate and over particle spacing."""
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    over_rate, over_spacing = figure.subplots(1, 2, sharey=True)
    rates = np.array(problem.rates)
    over_rate.loglog(rates, CONTINUUM_PEAK * rates**0.25, "--", color="0.5", label="continuum law, rate$^{1/4}$")
    over_rate.loglog(rates, [Pull(rate).reference().max() for rate in rates], "-", label="NumPy, the same flaws")
    over_rate.loglog(rates, [Pull(rate).engine(Harness()).max() for rate in rates], "o", label="engine")
    over_rate.set(xlabel="strain rate [1/s]", ylabel="peak stress [Pa]")
    over_rate.legend(loc="lower right")
    for rate in rates:
        bars = [Pull(rate, particles=count) for count in SIZES]
        spacing = [bar.body.spacing for bar in bars]
        over_spacing.loglog(spacing, [bar.engine(Harness()).max() for bar in bars], "o-", label=f"{rate:g} /s")
    over_spacing.set(xlabel="particle spacing $h$ [m] of a bar of 4.2 m$^3$")
    over_spacing.legend()
    return figure


def _cliff(problem: Cliff) -> Figure:
    """Surface of the collapsed cliff."""
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    for number, (when, state) in enumerate(problem.run(Harness()).items()):
        color, band, sph = f"C{number}", experiment(when), jutzi(when)
        axes.fill_between(*band.T, color=color, alpha=0.25, lw=0.0, label=f"{when}: experiments (Lajeunesse 2005)")
        axes.plot(*sph.T, "--", color=color, label=f"{when}: SPH (Jutzi 2015)")
        axes.step(*problem.profile(state), where="mid", color=color, label=f"{when}: engine")
    axes.set(xlabel="$L/L_0$", ylabel="$H/L_0$", xlim=(0.0, 8.0))
    axes.legend()
    return figure
