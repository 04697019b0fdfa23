"""The linear velocity field that fits moving particles best (engine/physics.md, section 9)."""

from dataclasses import dataclass

import numpy as np

from analysis.remnant.particles import Array
from analysis.remnant.spin import ROUND_OFF


@dataclass(frozen=True)
class LinearFlow:
    """v = v0 + L (x - x0), with position x0 and velocity v0 of the centre of mass.

    Attributes:
        gradient: velocity gradient L [1/s], shape [3, 3]; NaN for particles in one plane.
        residual: root mean square of the velocities that the field leaves over, divided by that of the velocities
            about the centre of mass [-]; NaN without a gradient or such velocities.
    """

    gradient: Array
    residual: float

    @property
    def spin_rate(self) -> float:
        """Half the magnitude of the vorticity, |curl v|/2 [rad/s]: that of a rigid body is its angular velocity."""
        vorticity = self.gradient - self.gradient.T
        return float(np.linalg.norm(vorticity) / np.sqrt(8.0))

    @property
    def strain_rate(self) -> float:
        """Largest principal value of sym L [1/s]: the fastest stretching, negative where every direction shrinks."""
        if not np.isfinite(self.gradient).all():
            return float("nan")
        return float(np.linalg.eigvalsh(0.5 * (self.gradient + self.gradient.T))[-1])


def linear_flow(position: Array, velocity: Array, mass: Array) -> LinearFlow:
    """Fit v = v0 + L (x - x0) by least squares, weighted by mass: L = (sum m v x^T) (sum m x x^T)^-1.

    Args:
        position: [m], shape [particle_count, 3].
        velocity: [m/s], shape [particle_count, 3].
        mass: [kg], shape [particle_count].
    """
    arm = position - np.average(position, axis=0, weights=mass)
    relative = velocity - np.average(velocity, axis=0, weights=mass)
    gradient = _gradient(arm, relative, mass)
    speed = _root_mean_square(relative, mass)
    if speed <= ROUND_OFF * _root_mean_square(velocity, mass):
        return LinearFlow(gradient, float("nan"))
    return LinearFlow(gradient, _root_mean_square(relative - arm @ gradient.T, mass) / speed)


def _gradient(arm: Array, relative: Array, mass: Array) -> Array:
    """L [1/s] of the fit; NaN where the arms span no volume."""
    second = np.einsum("p,pi,pj->ij", mass, arm, arm)
    extents = np.linalg.eigvalsh(second)
    if extents[0] <= ROUND_OFF * extents[2]:
        return np.full((3, 3), np.nan)
    return np.asarray(np.linalg.solve(second, np.einsum("p,pi,pj->ij", mass, arm, relative)).T, dtype=np.float64)


def _root_mean_square(vectors: Array, mass: Array) -> float:
    return float(np.sqrt(np.average(np.sum(vectors**2, axis=1), weights=mass)))
