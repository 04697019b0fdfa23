"""Conserved quantities, summed on the host in a fixed order (engine/physics.md, section 2)."""

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from engine.arrays import Scalars, Vector
from engine.quantities import HEATS
from engine.state.particles import Arrays

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

    @property
    def total_energy(self) -> float:
        """Sum of kinetic, affine, internal and gravitational energy at one time, and what was lost [J]."""
        kinetic = self.kinetic_energy + self.affine_kinetic_energy + self.half_step_work
        return kinetic + self.internal_energy + self.gravitational_energy + self.lost_energy


def totals(
    state: Arrays,
    inertia: float,
    elastic: Scalars,
    gravitational_energy: float,
    half_step_work: float,
    takes_heat: bool = True,
) -> Totals:
    """Return the conserved quantities of a state.

    Args:
        state: fields x, v, C, E, mass and the heats of every particle.
        inertia: moment of inertia per mass of the affine motion of a particle [m^2].
        elastic: elastic energy of every particle [J], shape [particle_count].
        gravitational_energy: potential energy of gravity [J].
        half_step_work: work of stress and gravity in the second half of the last step [J].
        takes_heat: whether internal energy contains the heat of the transfer.
    """
    m, x, v, C, E = (state[name] for name in ("mass", "x", "v", "C", "E"))
    skew = np.stack([C[:, 2, 1] - C[:, 1, 2], C[:, 0, 2] - C[:, 2, 0], C[:, 1, 0] - C[:, 0, 1]], axis=1)
    transfer, plastic, viscous = (float(np.sum(m * state[name])) for name in HEATS)
    return Totals(
        mass=float(np.sum(m)),
        momentum=np.sum(m[:, None] * v, axis=0),
        angular_momentum=np.sum(m[:, None] * (np.cross(x, v) + inertia * skew), axis=0),
        kinetic_energy=0.5 * float(np.sum(m * np.sum(v**2, axis=1))),
        affine_kinetic_energy=0.5 * inertia * float(np.sum(m * np.sum(C**2, axis=(1, 2)))),
        internal_energy=float(np.sum(m * E)),
        elastic_energy=float(np.sum(elastic)),
        gravitational_energy=gravitational_energy,
        half_step_work=half_step_work,
        transfer_heat=transfer,
        plastic_heat=plastic,
        viscous_heat=viscous,
        lost_energy=float(np.sum(m * state["affine_loss"])) + (0.0 if takes_heat else transfer),
    )


def half_step_work(state: Arrays, dt: float) -> float:
    """Return the work [J] of stress and gravity in the second half of a step, sum of m ((dt/2) v.g - half_step_work).

    Args:
        state: fields v, mass, acceleration and half_step_work of every particle.
        dt: length of the last step [s].
    """
    falling = np.einsum("pi,pi->p", state["v"], state["acceleration"])
    return float(np.sum(state["mass"] * (0.5 * dt * falling - state["half_step_work"])))


def elastic_energy(state: Arrays, rho0: Scalars, bulk: Scalars, shear: Scalars) -> Scalars:
    """Return the elastic energy [J], V (P^2/(2K J_c) + s:s/4G) for small strains, shape [particle_count].

    Args:
        state: fields j, tau, mass and plastic_dilation of every particle.
        rho0, bulk, shear: reference density [kg/m^3] and moduli [Pa] of every particle, shape [particle_count].
    """
    s = state["tau"].copy()
    pressure = -np.sum(s[:, :3], axis=1) / 3.0
    s[:, :3] += pressure[:, None]
    square = np.sum(s[:, :3] ** 2, axis=1) + 2.0 * np.sum(s[:, 3:] ** 2, axis=1)
    density = pressure**2 / (2.0 * bulk * (1.0 + state["plastic_dilation"])) + square / (4.0 * shear)
    return np.asarray(state["mass"] / rho0 * density)


def as_row(totals_now: Totals, **others: float) -> Row:
    """Return a row of the history.

    Args:
        totals_now: conserved quantities.
        others: the other quantities of the row, by name.
    """
    row = {**asdict(totals_now), "total_energy": totals_now.total_energy, **others}
    return {name: np.asarray(value, dtype=np.float64) for name, value in row.items()}
