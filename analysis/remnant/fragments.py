"""Clumps of particles, and what is bound to the largest of them (engine/physics.md, section 9)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from analysis.remnant.particles import Array, Integers, Particles
from engine.constants import G_NEWTON

LINKING_LENGTH = 1.5
"""Distance within which two particles are friends, in particle spacings h."""


def friends_of_friends(position: Array, mass: Array, length: float) -> Integers:
    """Clump label of every particle; 0 is the clump of largest mass, equal masses go by their first particle.

    Args:
        position: [m], shape [particle_count, 3].
        mass: [kg], shape [particle_count].
        length: linking length [m]; particles at exactly this distance are friends.
    """
    count = len(position)
    pairs = cKDTree(position).query_pairs(length, output_type="ndarray")
    links = coo_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    found = connected_components(links, directed=False)[1]
    _, first, labels = np.unique(found, return_index=True, return_inverse=True)
    order = np.lexsort((first, -np.bincount(labels, weights=mass)))
    return np.argsort(order)[labels]


OTHER_LENGTHS = {"mass_ratio_close": 1.2, "mass_ratio_wide": 1.8}
"""Linking lengths [h] that show, by an outcome each, whether the largest remnant is a matter of that length."""


@dataclass(frozen=True)
class Clumps:
    """Clumps as point masses, the largest first.

    Attributes:
        mass: [kg], shape [clump_count].
        position: centres of mass [m], shape [clump_count, 3].
        velocity: of the centres of mass [m/s], shape [clump_count, 3].
    """

    mass: Array
    position: Array
    velocity: Array


def clumps_of(particles: Particles, length: float = LINKING_LENGTH) -> Integers:
    """Clump label of every particle, shape [particle_count].

    Args:
        particles: to link.
        length: linking length in particle spacings [-].
    """
    return friends_of_friends(particles.position, particles.mass, length * particles.spacing)


def largest_clump(particles: Particles) -> Particles:
    """The particles of the largest clump."""
    return particles.select(clumps_of(particles) == 0)


def as_points(labels: Integers, mass: Array, position: Array, velocity: Array) -> Clumps:
    """The clumps of labelled particles.

    Args:
        labels: clump of each particle, shape [particle_count].
        mass: [kg], shape [particle_count].
        position: [m], shape [particle_count, 3].
        velocity: [m/s], shape [particle_count, 3].
    """
    total = np.bincount(labels, weights=mass).astype(np.float64)

    def mean(vectors: Array) -> Array:
        sums = [np.bincount(labels, weights=mass * component) for component in vectors.T]
        return np.stack(sums, axis=1) / total[:, None]

    return Clumps(total, mean(position), mean(velocity))


def bound_to_largest(clumps: Clumps) -> NDArray[np.bool_]:
    """Which clumps the largest binds, itself included, shape [clump_count].

    All clumps of negative two-body energy relative to the set's centre of mass join together, and the
    larger set is tried again until none joins.
    """
    bound: NDArray[np.bool_] = np.arange(len(clumps.mass)) == 0
    while (joining := ~bound & (_specific_energy(clumps, bound) < 0.0)).any():
        bound = bound | joining
    return bound


def _specific_energy(clumps: Clumps, bound: NDArray[np.bool_]) -> Array:
    """Energy per reduced mass, v^2/2 - G (M + m)/d [J/kg], of each clump and the bound set."""
    weight = clumps.mass * bound
    total = weight.sum()
    distance = np.linalg.norm(clumps.position - np.average(clumps.position, axis=0, weights=weight), axis=1)
    speed = np.linalg.norm(clumps.velocity - np.average(clumps.velocity, axis=0, weights=weight), axis=1)
    with np.errstate(divide="ignore"):
        return np.asarray(0.5 * speed**2 - G_NEWTON * (total + clumps.mass) / distance)
