"""Remove the net force and torque of accelerations computed by a tree.

Forces between pairs cancel in the sum. Those of a tree do not: a node acts on a particle, not the particle on the node
(engine/physics.md, section 7).
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Scalars, Vectors

TINY = 1e-300
"""Least denominator of a fraction, so that particles at rest give 0."""


@dataclass(frozen=True)
class NetForce:
    """Relative net force and torque of accelerations.

    Attributes:
        force: |sum of forces| over the sum of their magnitudes [-].
        torque: |sum of torques| over the sum of forces times distances from the centre of mass [-].
    """

    force: float
    torque: float


def remove_net_force_and_torque(pull: Vectors, x: Vectors, mass: Scalars) -> tuple[Vectors, NetForce]:
    """Subtract the rigid motion, a + omega x r, that carries the net force and torque.

    Of all corrections that cancel both it is the smallest in the mass-weighted mean square.

    Args:
        pull: accelerations [m/s^2], shape [particle_count, 3].
        x: positions [m], shape [particle_count, 3].
        mass: masses [kg], shape [particle_count].

    Returns:
        The accelerations [m/s^2], shape [particle_count, 3], and the net force and torque removed.
    """
    r = x - np.average(x, axis=0, weights=mass)
    lever = mass[:, None] * r
    mean = np.average(pull, axis=0, weights=mass)
    rest = pull - mean
    moments, turning = np.einsum("pi,pj->ij", lever, r), np.einsum("pi,pj->ij", lever, rest)
    torque = np.array([turning[1, 2] - turning[2, 1], turning[2, 0] - turning[0, 2], turning[0, 1] - turning[1, 0]])
    spin = np.linalg.pinv(np.trace(moments) * np.eye(3) - moments, hermitian=True) @ torque
    force, arm = mass * _length(pull), _length(r)
    removed = NetForce(
        force=float(mass.sum() * np.linalg.norm(mean) / max(force.sum(), TINY)),
        torque=float(np.linalg.norm(torque) / max((force * arm).sum(), TINY)),
    )
    return rest - np.cross(spin, r), removed


def _length(vectors: Vectors) -> Scalars:
    return np.asarray(np.sqrt(np.einsum("pi,pi->p", vectors, vectors)))
