"""Net force and torque, which forces between pairs do not have and those of a tree do."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vectors = NDArray[np.float64]

TINY = 1e-300


@dataclass(frozen=True)
class NetEffect:
    """What a solver's pulls would do to all particles together, though forces between pairs do nothing.

    Attributes:
        force: net force over the sum of the magnitudes of all forces.
        torque: net torque over the sum of all forces times distances from the centre of mass.
    """

    force: float
    torque: float


def without_net_effect(pull: Vectors, x: Vectors, mass: Vectors) -> tuple[Vectors, NetEffect]:
    """Accelerations without net force and net torque, which no forces between pairs have.

    Of all corrections that achieve this, the rigid motion taken out is the smallest in the mass-weighted mean square.

    Args:
        pull: accelerations [m/s^2], shape [particle_count, 3].
        x: positions [m], shape [particle_count, 3].
        mass: masses [kg], shape [particle_count].

    Returns:
        The accelerations [m/s^2], shape [particle_count, 3], and what was taken out.
    """
    r = x - np.average(x, axis=0, weights=mass)
    lever = mass[:, None] * r
    mean = np.average(pull, axis=0, weights=mass)
    rest = pull - mean
    moments, turning = np.einsum("pi,pj->ij", lever, r), np.einsum("pi,pj->ij", lever, rest)
    torque = np.array([turning[1, 2] - turning[2, 1], turning[2, 0] - turning[0, 2], turning[0, 1] - turning[1, 0]])
    spin = np.linalg.pinv(np.trace(moments) * np.eye(3) - moments, hermitian=True) @ torque
    force, arm = mass * _length(pull), _length(r)
    taken_out = NetEffect(
        force=float(mass.sum() * np.linalg.norm(mean) / max(force.sum(), TINY)),
        torque=float(np.linalg.norm(torque) / max((force * arm).sum(), TINY)),
    )
    return rest - np.cross(spin, r), taken_out


def _length(vectors: Vectors) -> Vectors:
    return np.asarray(np.sqrt(np.einsum("pi,pi->p", vectors, vectors)))
