"""A homogeneous ellipsoid of incompressible rubble under its own gravity, which keeps a linear velocity field.

Positions are x = F X with |X| <= 1, velocities v = L x. With B = (F F^T)^-1 the pressure P = P0 (1 - x.Bx) vanishes at
the surface, and friction s = mu P n, sqrt(J2) = mu P, has the direction n = e/sqrt(e:e/2) of strain, e = dev sym L.
Gravity is -2 pi G rho A x (Chandrasekhar 1969, chapter 3). All three are linear in x, and so is the acceleration:

    L' + L^2 = (2 P0/rho) (I - mu n) B - 2 pi G rho A,    F' = L F,    P0 from tr L' = 0.

A negative P0 means that matter comes apart; it then moves as dust, P0 = 0, until its density is rho0 again.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

from engine.arrays import Tensor, Vector
from engine.constants import G_NEWTON

SLOWEST = 1e-8
"""Rate of strain [1/s] below which friction falls in proportion to it: rubble at rest creeps slower than this."""

TOLERANCE = 1e-9
"""Relative error of one step of the integration."""


@dataclass(frozen=True)
class Motion:
    """Shape and velocity of the ellipsoid.

    Attributes:
        F: map of the unit sphere to the ellipsoid [m], shape [3, 3].
        L: velocity gradient [1/s], shape [3, 3].
    """

    F: Tensor
    L: Tensor

    @property
    def axes(self) -> Vector:
        """Full axes [m], longest first, shape [3]."""
        return np.asarray(2.0 * np.linalg.svd(self.F, compute_uv=False))

    @property
    def strain_rate(self) -> Tensor:
        """Deviatoric rate of strain e [1/s], shape [3, 3]."""
        d = 0.5 * (self.L + self.L.T)
        return np.asarray(d - np.trace(d) / 3.0 * np.eye(3))

    @property
    def flow(self) -> Tensor:
        """Direction n = e/sqrt(e:e/2) of friction [-], shape [3, 3]; e over SLOWEST where e is smaller."""
        e = self.strain_rate
        return np.asarray(e / max(float(np.sqrt(0.5 * np.sum(e**2))), SLOWEST))


@dataclass(frozen=True)
class RubbleEllipsoid:
    """Its matter, and the motion of it.

    Attributes:
        mass: total [kg].
        rho0: density where it bears pressure [kg/m^3].
        friction: coefficient mu [-], below sqrt(3)/2: P0 is positive at rest whatever the flow.
    """

    mass: float
    rho0: float
    friction: float

    def run(self, motion: Motion, times: Iterable[float]) -> Iterator[Motion]:
        """Yield the motion at increasing times [s]; friction of slow strain is stiff, so the integration is implicit.

        Args:
            motion: at t = 0.
            times: when to yield it.
        """
        now, dense = 0.0, self.pressure(motion) > 0.0 and np.trace(motion.L) < SLOWEST
        for time in times:
            while now < time:
                now, motion = self._phase(motion, dense, now, time)
                if now < time:
                    dense = not dense and self.pressure(motion) > 0.0
            yield motion

    def density(self, motion: Motion) -> float:
        """Return the density [kg/m^3]."""
        return self.mass / (4.0 / 3.0 * np.pi * float(np.linalg.det(motion.F)))

    def pressure(self, motion: Motion) -> float:
        """Return P0 at the centre [Pa] that keeps tr L constant; negative where matter comes apart."""
        rho = self.density(motion)
        divergence = float(np.trace(motion.L @ motion.L)) + 4.0 * np.pi * G_NEWTON * rho
        return 0.5 * rho * divergence / float(np.trace(self._push(motion)))

    def kinetic_energy(self, motion: Motion) -> float:
        """Return (M/10) tr(L F F^T L^T) [J]."""
        return 0.1 * self.mass * float(np.sum((motion.L @ motion.F) ** 2))

    def gravitational_energy(self, motion: Motion) -> float:
        """Return -(3/5) G M^2 R_F(a^2, b^2, c^2) [J], with semi-axes a, b and c and Carlson's R_F."""
        return -0.6 * G_NEWTON * self.mass**2 * float(elliprf(*(0.5 * motion.axes) ** 2))

    def friction_power(self, motion: Motion) -> float:
        """Return the integral of s : e over the volume [W], (2/5) (M/rho) P0 mu n : e."""
        rate = self.friction * float(np.sum(motion.flow * motion.strain_rate))
        return 0.4 * self.mass / self.density(motion) * max(self.pressure(motion), 0.0) * rate

    def angular_momentum(self, motion: Motion) -> Vector:
        """Return (M/5) times the axial vector of L F F^T [kg m^2/s], shape [3]."""
        S = motion.L @ motion.F @ motion.F.T
        return 0.2 * self.mass * np.array([S[2, 1] - S[1, 2], S[0, 2] - S[2, 0], S[1, 0] - S[0, 1]])

    def _push(self, motion: Motion) -> Tensor:
        """Gradient of the force of stress per 2 P0, (I - mu n) B [1/m^2]."""
        B = np.linalg.inv(motion.F @ motion.F.T)
        return np.asarray((np.eye(3) - self.friction * motion.flow) @ B)

    def _phase(self, motion: Motion, dense: bool, now: float, end: float) -> tuple[float, Motion]:
        """Time and motion when dense matter comes apart, or when dust is dense again, or at the end."""

        def rate(_: float, y: Vector) -> Vector:
            return self._rate(_motion(y), dense).ravel()

        def change(_: float, y: Vector) -> float:
            return self.pressure(_motion(y)) if dense else self.rho0 / self.density(_motion(y)) - 1.0

        change.terminal, change.direction = True, -1.0  # type: ignore[attr-defined]
        start, scale = np.ravel([motion.F, motion.L]), np.repeat([np.abs(motion.F).max(), SLOWEST], 9)
        path = solve_ivp(rate, (now, end), start, "Radau", events=change, rtol=TOLERANCE, atol=TOLERANCE * scale)
        now, after = float(path.t[-1]), _motion(path.y[:, -1])
        return now, self._compact(after) if dense or now < end else after

    def _rate(self, motion: Motion, dense: bool) -> Tensor:
        """F' and L' one after the other, shape [2, 3, 3]."""
        rho, L = self.density(motion), motion.L
        force = -2.0 * np.pi * G_NEWTON * rho * gravity_tensor(motion.F)
        if dense:
            force += 2.0 * self.pressure(motion) / rho * self._push(motion)
        return np.array([L @ motion.F, force - L @ L])

    def _compact(self, motion: Motion) -> Motion:
        """The motion at density rho0, its tr L taken away by an impulse of pressure and friction."""
        push = self._push(motion)
        F = motion.F * (self.density(motion) / self.rho0) ** (1.0 / 3.0)
        return Motion(F, motion.L - np.trace(motion.L) / np.trace(push) * push)


def _motion(y: Vector) -> Motion:
    """The motion that 18 numbers are."""
    F, L = y.reshape(2, 3, 3)
    return Motion(F, L)


def gravity_tensor(F: Tensor) -> Tensor:
    """Return A [-] of the gravity -2 pi G rho A x inside an ellipsoid, shape [3, 3].

    Its principal values are (2/3) abc R_D(a_j^2, a_k^2, a_i^2), with Carlson's R_D; their sum is 2.

    Args:
        F: map of the unit sphere to the ellipsoid [m], shape [3, 3].
    """
    square, axes = np.linalg.eigh(F @ F.T)
    return np.asarray(axes * _gravity_factors(square) @ axes.T)


def static_ratio(a: float, b: float, c: float) -> float:
    """Return the sqrt(J2)/P that an ellipsoid needs at rest, everywhere the same (Holsapple 2001, Icarus 154, 432).

    Every stress that balances gravity has the same mean over the volume, and the stresses that friction bears are a
    convex cone: rubble of less friction cannot rest.

    Args:
        a, b, c: axes, in any unit.
    """
    return float(np.sqrt(0.5 * np.sum(static_stress(np.diag([a, b, c])) ** 2)))


def static_stress(F: Tensor) -> Tensor:
    """Return the deviatoric stress over P [-] of an ellipsoid at rest, 1 - 3 A_i a_i^2/(sum of A_j a_j^2).

    Args:
        F: map of the unit sphere to the ellipsoid [m], shape [3, 3].
    """
    need = gravity_tensor(F) @ F @ F.T
    return np.asarray(np.eye(3) - 3.0 / np.trace(need) * need)


def thinnest_lens(friction: float) -> float:
    """Return the smallest c/a of an oblate lens of rubble at rest, for a friction coefficient below sqrt(3)/2."""
    return float(brentq(lambda c: static_ratio(1.0, 1.0, c) - friction, 1e-6, 1.0))


def _gravity_factors(square: Vector) -> Vector:
    """A_i of squared semi-axes a_i^2 [m^2], shape [3]."""
    return np.asarray(2.0 / 3.0 * np.sqrt(square.prod()) * elliprd(square[[1, 2, 0]], square[[2, 0, 1]], square))


def resting(F: Tensor, friction: float) -> Motion:
    """Return an ellipsoid at rest, creeping at most as SLOWEST says along the stress that balances gravity.

    Args:
        F: map of the unit sphere to the ellipsoid [m], shape [3, 3].
        friction: coefficient mu [-].
    """
    stress = static_stress(F)
    ratio = float(np.sqrt(0.5 * np.sum(stress**2)))
    return Motion(F, SLOWEST / max(ratio, friction) * stress)
