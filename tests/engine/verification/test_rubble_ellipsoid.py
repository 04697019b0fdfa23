"""The exact motion of an ellipsoid of rubble."""

import numpy as np
import pytest
from scipy.integrate import simpson

from engine.constants import G_NEWTON
from engine.verification.rubble_ellipsoid import (
    Motion,
    RubbleEllipsoid,
    gravity_tensor,
    resting,
    static_ratio,
    static_stress,
    thinnest_lens,
)

RHO = 2700.0
RADIUS = 63e3
MASS = 4.0 / 3.0 * np.pi * RHO * RADIUS**3


def body(friction: float) -> RubbleEllipsoid:
    return RubbleEllipsoid(MASS, RHO, friction)


def shape(a: float, b: float, c: float) -> np.ndarray:
    """Map of the unit sphere to an ellipsoid of these proportions and the body's volume."""
    return np.diag([a, b, c]) * RADIUS / (a * b * c) ** (1.0 / 3.0)


def spin(x: float, y: float, z: float) -> np.ndarray:
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def spreading() -> Motion:
    """A triaxial ellipsoid that stretches, shears and turns about a skew axis."""
    L = np.diag([5e-4, 2e-4, -7e-4]) + spin(1e-4, -2e-4, 3e-4)
    L[0, 2] += 2e-4
    return Motion(shape(1.3, 1.1, 0.7), L)


def oblate_factors(ratio: float) -> np.ndarray:
    """A_i of an oblate ellipsoid in closed form (Chandrasekhar 1969, chapter 3, eq. 36)."""
    e = np.sqrt(1.0 - ratio**2)
    across = ratio / e**3 * np.arcsin(e) - ratio**2 / e**2
    return np.array([across, across, 2.0 - 2.0 * across])


def test_gravity_is_that_of_closed_forms():
    np.testing.assert_allclose(gravity_tensor(2.0 * np.eye(3)), 2.0 / 3.0 * np.eye(3), atol=1e-14)
    np.testing.assert_allclose(gravity_tensor(shape(1.0, 1.0, 0.4)), np.diag(oblate_factors(0.4)), atol=1e-13)
    assert np.trace(gravity_tensor(spreading().F + shape(0.2, 1.0, 3.0))) == pytest.approx(2.0, rel=1e-13)


def test_gravity_is_the_gradient_of_its_energy():
    """dW/dt of any motion is the power of -2 pi G rho A x, whose integral over the body is (M/5) tr(L^T A F F^T)."""
    motion, rubble, dt = spreading(), body(0.6), 1e-2
    pull = -2.0 * np.pi * G_NEWTON * RHO * gravity_tensor(motion.F)
    power = 0.2 * MASS * np.sum((motion.L @ motion.F) * (pull @ motion.F))
    before, after = (Motion(motion.F + sign * dt * motion.L @ motion.F, motion.L) for sign in (-1.0, 1.0))
    change = rubble.gravitational_energy(after) - rubble.gravitational_energy(before)
    assert power == pytest.approx(-change / (2.0 * dt), rel=1e-6)


def test_energy_falls_by_the_work_of_friction_and_angular_momentum_stays():
    rubble, start = body(0.6), spreading()
    times = np.linspace(0.0, 1000.0, 201)
    path = list(rubble.run(start, times))
    energy = [rubble.kinetic_energy(motion) + rubble.gravitational_energy(motion) for motion in path]
    power = [rubble.friction_power(motion) for motion in path]
    assert min(power) >= 0.0
    lost = energy[0] - energy[-1]
    assert lost > 0.2 * rubble.kinetic_energy(start)
    assert lost == pytest.approx(simpson(power, x=times), rel=1e-6)
    spins = np.array([rubble.angular_momentum(motion) for motion in path])
    np.testing.assert_allclose(spins, np.broadcast_to(spins[0], spins.shape), rtol=1e-7)
    np.testing.assert_allclose([rubble.density(motion) for motion in path], RHO, rtol=1e-7)


def test_motion_without_friction_can_be_reversed():
    rubble, start = body(0.0), spreading()
    (out,) = rubble.run(start, [1000.0])
    (back,) = rubble.run(Motion(out.F, -out.L), [1000.0])
    assert np.abs(out.F - start.F).max() > 0.1 * RADIUS
    np.testing.assert_allclose(back.F, start.F, atol=1e-6 * RADIUS)
    np.testing.assert_allclose(back.L, -start.L, atol=1e-6 * np.abs(start.L).max())


def test_a_maclaurin_spheroid_needs_no_friction():
    """omega^2/(pi G rho) = 2 (1 - e^2)^(1/2) (3 - 2 e^2) asin(e)/e^3 - 6 (1 - e^2)/e^2 (Chandrasekhar 1969, 5.4)."""
    ratio, rubble = 0.7, body(0.0)
    e = np.sqrt(1.0 - ratio**2)
    rate2 = 2.0 * ratio * (3.0 - 2.0 * e**2) * np.arcsin(e) / e**3 - 6.0 * ratio**2 / e**2
    turning = spin(0.0, 0.0, np.sqrt(np.pi * G_NEWTON * RHO * rate2))
    start = Motion(shape(1.0, 1.0, ratio), turning)
    (end,) = rubble.run(start, [5000.0])
    np.testing.assert_allclose(end.axes, start.axes, rtol=1e-6)
    np.testing.assert_allclose(end.L, turning, atol=1e-6 * turning.max())


def test_a_triaxial_body_turns_as_a_rigid_one_while_friction_bears_it():
    rate, start_shape = 2e-4, shape(1.3, 1.0, 0.8)
    start = Motion(start_shape, spin(0.0, 0.0, rate))
    (end,) = body(0.8).run(start, [5000.0])
    angle = 5000.0 * rate
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    # creep of at most SLOWEST for 5,000 s
    np.testing.assert_allclose(end.F, turn @ start_shape, atol=1e-4 * RADIUS)
    (flowing,) = body(0.1).run(start, [5000.0])
    assert np.abs(flowing.axes / start.axes - 1.0).max() > 0.05


def test_matter_thrown_apart_is_dust_until_it_is_dense_again():
    """A sphere with v = H r turns at r/R = 1/(1 - H^2 R^3/(2 G M)) and is back, as a cycloid says; then it rests."""
    rate, rubble = 5e-4, body(0.6)
    start = Motion(shape(1.0, 1.0, 1.0), rate * np.eye(3))
    stretch = 1.0 / (1.0 - rate**2 * RADIUS**3 / (2.0 * G_NEWTON * MASS))
    angle = np.arccos(np.sqrt(1.0 / stretch))
    half = (angle + 0.5 * np.sin(2.0 * angle)) * np.sqrt((stretch * RADIUS) ** 3 / (2.0 * G_NEWTON * MASS))
    turned, before, after = rubble.run(start, [half, 2.0 * half - 1.0, 2.0 * half + 1.0])
    np.testing.assert_allclose(turned.axes, 2.0 * stretch * RADIUS, rtol=1e-6)
    np.testing.assert_allclose(before.L, -rate * np.eye(3), rtol=1e-2, atol=1e-9)
    np.testing.assert_allclose(after.L, 0.0, atol=1e-3 * rate)
    assert rubble.density(after) == pytest.approx(RHO, rel=1e-9)


@pytest.mark.parametrize(
    ("friction", "ratio"), [(0.5, 0.278), (0.6, 0.189), (0.7, 0.111), (0.839, 0.017)], ids=lambda value: str(value)
)
def test_the_thinnest_lens_at_rest(friction, ratio):
    thinnest = thinnest_lens(friction)
    assert thinnest == pytest.approx(ratio, abs=5e-4)
    need = oblate_factors(thinnest) * [1.0, 1.0, thinnest**2]
    deviator = 1.0 - 3.0 * need / need.sum()
    assert np.sqrt(0.5 * np.sum(deviator**2)) == pytest.approx(friction, rel=1e-9)


def test_a_lens_rests_or_contracts_as_the_static_limit_says():
    friction = 0.5
    thick, thin = 1.05 * thinnest_lens(friction), 0.95 * thinnest_lens(friction)
    ends = []
    for ratio in (thick, thin):
        (end,) = body(friction).run(resting(shape(1.0, 1.0, ratio), friction), [2000.0])
        ends.append(end.axes[2] / end.axes[0])
    assert ends[0] == pytest.approx(thick, rel=1e-4)
    assert ends[1] > 1.02 * thin


def test_resting_rubble_bears_the_stress_of_balance():
    F, friction = shape(1.2, 1.0, 0.6), 0.6
    motion = resting(F, friction)
    np.testing.assert_allclose(friction * motion.flow, static_stress(F), atol=1e-12)
    assert static_ratio(1.2, 1.0, 0.6) < friction
    # hydrostatic pressure of a sphere
    ball = Motion(shape(1.0, 1.0, 1.0), np.zeros((3, 3)))
    assert body(0.6).pressure(ball) == pytest.approx(2.0 / 3.0 * np.pi * G_NEWTON * RHO**2 * RADIUS**2, rel=1e-12)
