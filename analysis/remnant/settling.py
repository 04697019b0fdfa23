"""Whether shape and mass of the largest remnant are steady."""

from dataclasses import dataclass

import numpy as np

from analysis.remnant.ellipsoid import ellipsoid_of
from analysis.remnant.fragments import largest_clump
from analysis.remnant.particles import Particles, read_particles, snapshots
from engine.job.directory import JobDirectory

WINDOW = 0.1
"""Fraction of the time since contact, up to its end, in which shape and mass must not change."""

OLDEST = 0.5
"""Largest fraction to which the window is widened when snapshots are sparse."""

TOLERANCE = 0.02
"""Relative change of b/a, c/a and mass in the window below which a remnant is settled.

A remnant that oscillates is momentarily at rest at its greatest stretch: it counts as settled when the window is short
against its period."""


@dataclass(frozen=True)
class Changes:
    """Largest relative differences between the remnant and the snapshots of the window; NaN when unknown.

    Attributes:
        shape: of b/a and c/a [-].
        mass: [-].
    """

    shape: float
    mass: float

    @property
    def settled(self) -> float:
        """1 when both are below `TOLERANCE`, 0 when not, NaN when one is unknown."""
        both = np.array([self.shape, self.mass])
        return float((both < TOLERANCE).all()) if np.isfinite(both).all() else float("nan")


UNKNOWN = Changes(float("nan"), float("nan"))
"""Changes of a remnant without snapshots of the right age."""


def recent_changes(remnant: Particles, job: JobDirectory) -> Changes:
    """Compare the remnant with the largest clump in each snapshot of the window.

    Args:
        remnant: the largest clump at the end.
        job: where the snapshots are; `UNKNOWN` when none reaches back far enough.

    Raises:
        JobError: a snapshot cannot be read.
    """
    taken = snapshots(job)
    times = np.array([time for time, _ in taken])
    before = times[(times >= (1.0 - OLDEST) * remnant.time) & (times <= (1.0 - WINDOW) * remnant.time)]
    if not before.size or remnant.time <= 0.0:
        return UNKNOWN
    window = [path for time, path in taken if before.max() <= time < remnant.time]
    earlier = np.array([_measures(largest_clump(read_particles(path))) for path in window])
    final = np.array(_measures(remnant))
    b_over_a, c_over_a, mass = np.max(np.abs(earlier - final) / final, axis=0)
    return Changes(shape=float(max(b_over_a, c_over_a)), mass=float(mass))


def _measures(clump: Particles) -> list[float]:
    """b/a [-], c/a [-] and mass [kg]."""
    shape = ellipsoid_of(clump.position, clump.mass)
    return [shape.b_over_a, shape.c_over_a, float(clump.mass.sum())]
