"""The rotation of a clump about its centre of mass."""

import numpy as np

from analysis.remnant.ellipsoid import inertia
from analysis.remnant.particles import Array

ROUND_OFF = 1e-12
"""Relative size below which a moment of inertia or an angular momentum is only round-off."""


def angular_velocity(position: Array, velocity: Array, mass: Array) -> Array:
    """I^-1 L about the centre of mass [rad/s], shape [3]; NaN for points on one line.

    Args:
        position: [m], shape [particle_count, 3].
        velocity: [m/s], shape [particle_count, 3].
        mass: [kg], shape [particle_count].
    """
    tensor = inertia(position, mass)
    moments = np.linalg.eigvalsh(tensor)
    if moments[0] <= ROUND_OFF * moments[2]:
        return np.full(3, np.nan)
    return np.asarray(np.linalg.solve(tensor, _angular_momentum(position, velocity, mass)), dtype=np.float64)


def spin_period(position: Array, velocity: Array, mass: Array) -> float:
    """2 pi / |omega| [s]; NaN where there is no rotation or it is undefined. Arguments as `angular_velocity`."""
    rate = float(np.linalg.norm(angular_velocity(position, velocity, mass)))
    return 2.0 * np.pi / rate if rate > 0.0 else float("nan")


def _angular_momentum(position: Array, velocity: Array, mass: Array) -> Array:
    """L about the centre of mass [kg m^2/s], zero where it is round-off."""
    arm = position - np.average(position, axis=0, weights=mass)
    relative = velocity - np.average(velocity, axis=0, weights=mass)
    momentum = np.einsum("p,pi->i", mass, np.cross(arm, relative))
    largest = np.sum(mass * np.linalg.norm(arm, axis=1) * np.linalg.norm(velocity, axis=1))
    return np.where(np.linalg.norm(momentum) > ROUND_OFF * largest, momentum, 0.0)
