"""Whether the shape of the largest remnant is steady."""

import numpy as np

from analysis.remnant.ellipsoid import Ellipsoid, ellipsoid_of
from analysis.remnant.fragments import largest_clump
from analysis.remnant.particles import Particles, read_particles, snapshots
from engine.job.directory import JobDirectory

WINDOW = 0.1
"""Fraction of the time since contact, up to its end, in which the shape must not change."""

OLDEST = 0.5
"""Largest fraction to which the window is widened when snapshots are sparse."""

TOLERANCE = 0.02
"""Relative change of b/a and c/a in the window below which a shape is settled.

A remnant that oscillates is momentarily at rest at its greatest stretch: it counts as settled when the window is short
against its period."""


def shape_change(remnant: Particles, job: JobDirectory) -> float:
    """Largest relative difference [-] of b/a and c/a between the remnant and the snapshots of the window.

    Args:
        remnant: the largest clump at the end.
        job: where the snapshots are; NaN when none reaches back far enough.

    Raises:
        JobError: a snapshot cannot be read.
    """
    taken = snapshots(job)
    times = np.array([time for time, _ in taken])
    before = times[(times >= (1.0 - OLDEST) * remnant.time) & (times <= (1.0 - WINDOW) * remnant.time)]
    if not before.size or remnant.time <= 0.0:
        return float("nan")
    final = _ratios(ellipsoid_of(remnant.position, remnant.mass))
    window = [path for time, path in taken if before.max() <= time < remnant.time]
    earlier = [largest_clump(read_particles(path)) for path in window]
    ratios = np.array([_ratios(ellipsoid_of(clump.position, clump.mass)) for clump in earlier])
    return float(np.max(np.abs(ratios - final) / final))


def is_settled(change: float) -> float:
    """1 when a shape that changed by `change` is settled, 0 when not, NaN when unknown."""
    return float(change < TOLERANCE) if np.isfinite(change) else float("nan")


def _ratios(shape: Ellipsoid) -> list[float]:
    return [shape.b_over_a, shape.c_over_a]
