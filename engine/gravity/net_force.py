"""Remove the net force and torque of accelerations computed by a tree.

Forces between pairs cancel in the sum. Those of a tree do not: a node acts on a particle, not the particle on the node
(engine/physics.md, section 7).
"""

from dataclasses import dataclass

import numpy as np
import taichi as ti

from engine.device.backend import Real, place3
from engine.device.fields import allocate
from engine.device.fixed_order_sum import FixedOrderSum

TINY = 1e-300
"""Least denominator of a fraction, so that particles at rest give 0."""


@dataclass(frozen=True)
class NetForce:
    """Relative net force and torque of accelerations, and how they changed.

    Attributes:
        force: |sum of forces| over the sum of their magnitudes [-].
        torque: |sum of torques| over the sum of forces times distances from the centre of mass [-].
        change: root mean square of the change of the corrected accelerations, over that of themselves [-].
    """

    force: float
    torque: float
    change: float


@ti.data_oriented
class RigidCorrection:
    """Subtracts the rigid motion, a + omega x r, that carries the net force and torque.

    Of all corrections that cancel both it is the smallest in the mass-weighted mean square.

    Args:
        x: positions [m].
        mass: masses [kg].
        pull: accelerations [m/s^2] to correct.
        acceleration: where the corrected ones are kept.
        count: number of particles.
    """

    def __init__(self, x: ti.Field, mass: ti.Field, pull: ti.Field, acceleration: ti.Field, count: int) -> None:
        self.x, self.mass, self.pull, self.acceleration, self.count = x, mass, pull, acceleration, count
        self.centre, self.mean, self.spin = (allocate(place3) for _ in range(3))
        self.linear = FixedOrderSum(self.linear_moments, 7, count)
        self.angular = FixedOrderSum(self.angular_moments, 11, count)
        self.corrected = FixedOrderSum(self.correct, 2, count)

    def apply(self) -> NetForce:
        """Set the accelerations to the corrected ones; return what was removed."""
        mass, *moments = self.linear.over(self.count)
        centre, mean = np.array(moments[:3]) / mass, np.array(moments[3:]) / mass
        self.centre[None], self.mean[None] = centre.tolist(), mean.tolist()
        *second, tx, ty, tz, force, arm = self.angular.over(self.count)
        moments, torque = _symmetric(second), np.array([tx, ty, tz])
        spin = np.linalg.pinv(np.trace(moments) * np.eye(3) - moments, hermitian=True) @ torque
        self.spin[None] = spin.tolist()
        change, size = self.corrected.over(self.count)
        return NetForce(
            force=float(mass * np.linalg.norm(mean) / max(force, TINY)),
            torque=float(np.linalg.norm(torque) / max(arm, TINY)),
            change=float(np.sqrt(change) / max(np.sqrt(size), TINY)),
        )

    @ti.func
    def linear_moments(self, p):
        """Return m, m x and m a of particle p."""
        m, x, a = ti.cast(self.mass[p], ti.f64), self.x[p], self.pull[p]
        return ti.Vector([m, m * x[0], m * x[1], m * x[2], m * a[0], m * a[1], m * a[2]])

    @ti.func
    def angular_moments(self, p):
        """Return the six m r r^T, m r x (a - mean), |m a| and |r| |m a| of particle p, from the centre of mass."""
        m, r = ti.cast(self.mass[p], ti.f64), self.x[p] - self.centre[None]
        turning, force = m * r.cross(self.pull[p] - self.mean[None]), m * self.pull[p].norm()
        xx, yy, zz = m * r[0] * r[0], m * r[1] * r[1], m * r[2] * r[2]
        yz, zx, xy = m * r[1] * r[2], m * r[2] * r[0], m * r[0] * r[1]
        return ti.Vector([xx, yy, zz, yz, zx, xy, turning[0], turning[1], turning[2], force, r.norm() * force])

    @ti.func
    def correct(self, p):
        """Set the acceleration of particle p; return the squares of its change and of itself."""
        spin, r = self.spin[None], self.x[p] - self.centre[None]
        before = ti.cast(self.acceleration[p], ti.f64)
        after = self.pull[p] - self.mean[None] - spin.cross(r)
        self.acceleration[p] = ti.cast(after, Real)
        return ti.Vector([(after - before).norm_sqr(), after.norm_sqr()])


def _symmetric(six):
    """Matrix of the components xx, yy, zz, yz, zx, xy."""
    xx, yy, zz, yz, zx, xy = six
    return np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
