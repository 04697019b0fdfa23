"""The uniform ellipsoid that has a clump's mass and inertia tensor (engine/physics.md, section 9)."""

from dataclasses import dataclass

import numpy as np

from analysis.remnant.particles import Array

THIN = 4.0
"""A remnant whose shortest axis is below this many particle spacings h is thin: its c/a is not resolved."""

NO_EXTENT = 1e-12
"""Squared axes below this fraction of the largest are round-off, and count as zero."""


@dataclass(frozen=True)
class Ellipsoid:
    """A uniform ellipsoid.

    Attributes:
        axes: full axes a >= b >= c [m], shape [3].
        directions: unit vectors along a, b and c as rows, right-handed, shape [3, 3].
    """

    axes: Array
    directions: Array

    @property
    def b_over_a(self) -> float:
        """Intermediate over longest axis [-]; NaN for a single point."""
        return _ratio(self.axes[1], self.axes[0])

    @property
    def c_over_a(self) -> float:
        """Shortest over longest axis [-]; NaN for a single point."""
        return _ratio(self.axes[2], self.axes[0])

    @property
    def volume(self) -> float:
        """pi/6 a b c [m^3]."""
        return float(np.pi / 6.0 * self.axes.prod())


def ellipsoid_of(position: Array, mass: Array, spacing: float = 0.0) -> Ellipsoid:
    """The ellipsoid of a clump of particles.

    Args:
        position: [m], shape [particle_count, 3].
        mass: [kg], shape [particle_count].
        spacing: edge [m] of the cube each particle fills; 0 takes particles as points, which understates a thin axis.
    """
    return ellipsoid_from(inertia(position, mass, spacing), float(mass.sum()))


def ellipsoid_from(tensor: Array, mass: float) -> Ellipsoid:
    """The ellipsoid of an inertia tensor: a^2 = 10 (I1 + I2 - I3)/M, and cyclic.

    Args:
        tensor: inertia tensor about the centre of mass [kg m^2], shape [3, 3].
        mass: [kg].
    """
    moments, vectors = np.linalg.eigh(tensor)
    squares = 10.0 * (moments.sum() - 2.0 * moments) / mass
    squares[squares < NO_EXTENT * squares[0]] = 0.0
    return Ellipsoid(np.sqrt(squares), _right_handed(vectors.T))


def inertia(position: Array, mass: Array, spacing: float = 0.0) -> Array:
    """Inertia tensor about the centre of mass [kg m^2], shape [3, 3]; arguments as `ellipsoid_of`."""
    centred = position - np.average(position, axis=0, weights=mass)
    second = np.einsum("p,pi,pj->ij", mass, centred, centred)
    second += np.eye(3) * mass.sum() * spacing**2 / 12.0
    return np.asarray(np.trace(second) * np.eye(3) - second)


def kurtosis(position: Array, mass: Array, direction: Array) -> float:
    """<x^4>/<x^2>^2 of the distances x from the centre of mass along a direction, weighted by mass [-].

    15/7 of a uniform ellipsoid, 9/5 of a rod, 1 of two points; NaN without extent in that direction.

    Args:
        position: [m], shape [particle_count, 3].
        mass: [kg], shape [particle_count].
        direction: unit vector, shape [3].
    """
    along = (position - np.average(position, axis=0, weights=mass)) @ direction
    return _ratio(np.average(along**4, weights=mass), np.average(along**2, weights=mass) ** 2)


def bulk_density(mass: float, volume: float) -> float:
    """Mass [kg] over volume [m^3]; NaN without volume."""
    return _ratio(mass, volume)


def _right_handed(directions: Array) -> Array:
    """The same lines, a and c pointing to the positive side of their largest component."""
    long, _, short = (row * np.sign(row[np.argmax(np.abs(row))]) for row in directions)
    return np.stack([long, np.cross(short, long), short])


def _ratio(numerator: float, denominator: float) -> float:
    return float(numerator / denominator) if denominator > 0.0 else float("nan")
