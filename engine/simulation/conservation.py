"""Conserved quantities of all particles, and the rows of the history (engine/physics.md, section 2)."""

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from engine.arrays import Vector

Row = dict[str, NDArray[np.float64]]
"""One row of the history: values by name (engine/quantities.py), numbers or vectors of shape [3]."""


@dataclass(frozen=True)
class Totals:
    """Sums over all particles.

    Attributes:
        mass: total mass [kg].
        momentum: total momentum [kg m/s], shape [3].
        angular_momentum: total angular momentum about the origin [kg m^2/s], affine part included, shape [3].
        kinetic_energy: of the particles' mean motion [J].
        affine_kinetic_energy: of the motion inside particles [J].
        internal_energy: all work of stress, elastic energy included [J].
        elastic_energy: part of the internal energy that is stored in strain [J].
        gravitational_energy: potential energy of gravity [J].
        half_step_work: work of stress and gravity in the second half of the last step [J]. Velocities belong to its
            middle; this takes kinetic energy to the time of the other energies.
        transfer_heat, plastic_heat, viscous_heat: energy that motion has lost since the start, by cause [J].
        lost_energy: what affine motion has lost in free motion, and heat that internal energy does not contain [J].
        damaged_fraction: mean damage [-].
        compressed_fraction: share of the mass that is under pressure [-].
    """

    mass: float
    momentum: Vector
    angular_momentum: Vector
    kinetic_energy: float
    affine_kinetic_energy: float
    internal_energy: float
    elastic_energy: float
    gravitational_energy: float
    half_step_work: float
    transfer_heat: float
    plastic_heat: float
    viscous_heat: float
    lost_energy: float
    damaged_fraction: float
    compressed_fraction: float

    @property
    def total_energy(self) -> float:
        """Sum of kinetic, affine, internal and gravitational energy at one time, and what was lost [J]."""
        kinetic = self.kinetic_energy + self.affine_kinetic_energy + self.half_step_work
        return kinetic + self.internal_energy + self.gravitational_energy + self.lost_energy


def as_row(totals_now: Totals, **others: float) -> Row:
    """Return a row of the history.

    Args:
        totals_now: conserved quantities.
        others: the other quantities of the row, by name.
    """
    row = {**asdict(totals_now), "total_energy": totals_now.total_energy, **others}
    return {name: np.asarray(value, dtype=np.float64) for name, value in row.items()}
