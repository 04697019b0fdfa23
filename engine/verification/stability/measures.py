"""Extremes of a run's history, and the bounds within which it is stable."""

from dataclasses import asdict, dataclass

import numpy as np

from engine.simulation.bounds import energy_growth, keeps_energy, momentum_drift
from engine.simulation.conservation import Row
from engine.simulation.guard import Guard

LARGEST_GROWTH = 0.02
"""Growth of the total energy up to which a run is stable, in the measure of engine.simulation.bounds.energy_growth."""


@dataclass(frozen=True)
class Measures:
    """Extremes over all rows of a history; NaN where not known.

    Attributes:
        mass_change: largest change of the total mass, over the total mass [-].
        momentum_drift: largest change of momentum over mass times the scene's speeds [-].
        momentum_bound: one unit in the last place of that per time step [-].
        energy_growth: largest growth of the total energy, over the sum of all energies [-].
        dissipation: loss of total energy from start to end, over the same sum [-].
        speed: highest speed [m/s].
        speed_bound: speed at which the guard stops [m/s].
        compression: highest rho/rho0 [-].
        compression_bound: rho/rho0 at which the guard stops [-].
    """

    mass_change: float = np.nan
    momentum_drift: float = np.nan
    momentum_bound: float = np.nan
    energy_growth: float = np.nan
    dissipation: float = np.nan
    speed: float = np.nan
    speed_bound: float = np.nan
    compression: float = np.nan
    compression_bound: float = np.nan

    def ratios(self) -> dict[str, float]:
        """Return the ratio of each measure to its bound."""
        return {
            "mass": np.inf if self.mass_change else 0.0,
            "momentum": self.momentum_drift / self.momentum_bound,
            "energy": self.energy_growth / LARGEST_GROWTH,
            "speed": self.speed / self.speed_bound,
            "rho/rho0": max(self.compression - 1.0, 0.0) / (self.compression_bound - 1.0),
        }

    @property
    def nearest(self) -> float:
        """The largest ratio of a measure to its bound."""
        known = [ratio for ratio in self.ratios().values() if not np.isnan(ratio)]
        return max(known, default=np.nan)

    def broken(self) -> str:
        """Return the bounds that are exceeded, in words; empty if none is."""
        return ", ".join(f"{name} at {ratio:.3g} of its bound" for name, ratio in self.ratios().items() if ratio > 1.0)


def measures(guard: Guard, rows: list[Row], epsilon: float) -> Measures:
    """Return the measures of a history; without a row none is known.

    Args:
        guard: of the run.
        rows: of its history.
        epsilon: spacing of the numbers of its precision at 1.
    """
    if not rows:
        return Measures()
    start, last = rows[0], rows[-1]
    growth = [energy_growth(guard.scene, row, start) for row in rows]
    known = keeps_energy(guard.scene)
    return Measures(
        mass_change=max(abs(float(row["mass"] / start["mass"]) - 1.0) for row in rows),
        momentum_drift=max(momentum_drift(row, start) for row in rows) / guard.momentum,
        momentum_bound=epsilon * max(float(last["step"]), 1.0),
        energy_growth=max(growth) if known else np.nan,
        dissipation=-growth[-1] if known else np.nan,
        speed=max(float(row["largest_speed"]) for row in rows),
        speed_bound=guard.speed,
        compression=max(float(row["largest_compression"]) for row in rows),
        compression_bound=guard.compression,
    )


def as_numbers(measures: Measures) -> dict[str, float]:
    """Return all measures by name, with the largest ratio to a bound as `nearest`."""
    return {**asdict(measures), "nearest": measures.nearest}
