"""Conserved quantities of a state summed with NumPy, independently of the device."""

import numpy as np

from engine.arrays import Scalars
from engine.quantities import HEATS
from engine.simulation.conservation import Totals
from engine.simulation.ledger import Extremes
from engine.state.particles import Arrays


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
        damaged_fraction=float(np.mean(state["damage_root"] ** 3)),
        compressed_fraction=float(np.average(state["j"] < state["plastic_dilation"], weights=m)),
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


def extremes(state: Arrays) -> Extremes:
    """What no particle of a state exceeds."""
    return Extremes(
        speed=float(np.linalg.norm(state["v"], axis=1).max()),
        density=float(1.0 / (1.0 + state["j"].min())),
        compression=float(((1.0 + state["plastic_dilation"]) / (1.0 + state["j"])).max()),
        is_finite=all(bool(np.isfinite(values).all()) for values in state.values()),
    )
