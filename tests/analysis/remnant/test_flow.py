"""The linear flow of particles, against flows that are linear and flows that are not."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.remnant.flow import linear_flow
from analysis.remnant.spin import angular_velocity
from tests.helpers.fake_jobs import lattice_ellipsoid

POINTS, _ = lattice_ellipsoid((2e5, 1e5, 8e4), 500)
MASS = np.random.default_rng(0).uniform(1.0, 2.0, len(POINTS))
OMEGA = np.array([1e-4, -2e-4, 3e-4])
SPIN = np.array([[0.0, -OMEGA[2], OMEGA[1]], [OMEGA[2], 0.0, -OMEGA[0]], [-OMEGA[1], OMEGA[0], 0.0]])
"""The matrix with SPIN x = OMEGA cross x."""

rate = st.integers(-1000, 1000).map(lambda number: 1e-6 * number)


@settings(max_examples=25, deadline=None)
@given(gradient=st.lists(st.lists(rate, min_size=3, max_size=3), min_size=3, max_size=3))
def test_a_linear_flow_gives_its_gradient_back(gradient: list[list[float]]) -> None:
    velocity = (POINTS + 3e4) @ np.array(gradient).T + np.array([300.0, -20.0, 5.0])
    flow = linear_flow(POINTS + np.array([1e6, 0.0, -1e6]), velocity, MASS)
    np.testing.assert_allclose(flow.gradient, gradient, rtol=0.0, atol=1e-15)
    assert np.isnan(flow.residual) or flow.residual < 1e-10


def test_a_rigid_rotator_spins_and_does_not_strain() -> None:
    flow = linear_flow(POINTS, np.cross(OMEGA, POINTS), MASS)
    np.testing.assert_allclose(flow.gradient, SPIN, atol=1e-17)
    np.testing.assert_allclose(flow.spin_rate, np.linalg.norm(OMEGA), rtol=1e-12)
    np.testing.assert_allclose(flow.spin_rate, np.linalg.norm(angular_velocity(POINTS, np.cross(OMEGA, POINTS), MASS)))
    assert abs(flow.strain_rate) < 1e-12 * flow.spin_rate and flow.residual < 1e-12


def test_simple_shear_is_as_much_spin_as_strain() -> None:
    flow = linear_flow(POINTS, 4e-4 * POINTS[:, [1]] * np.array([1.0, 0.0, 0.0]), MASS)
    np.testing.assert_allclose([flow.spin_rate, flow.strain_rate], [2e-4, 2e-4], rtol=1e-10)


@pytest.mark.parametrize("strain", [3e-4, -3e-4])
def test_expansion_strains_and_does_not_spin(strain: float) -> None:
    flow = linear_flow(POINTS, strain * POINTS, MASS)
    np.testing.assert_allclose(flow.strain_rate, strain, rtol=1e-10)
    assert flow.spin_rate < 1e-12 * abs(strain)


def test_velocities_without_order_are_all_left_over() -> None:
    random = np.random.default_rng(1).normal(size=POINTS.shape)
    points, velocity = np.concatenate([POINTS, -POINTS]), np.concatenate([random, random])
    flow = linear_flow(points, velocity, np.concatenate([MASS, MASS]))
    # Opposite particles of the same velocity: sum m v x^T vanishes.
    np.testing.assert_allclose(flow.residual, 1.0, rtol=1e-12)
    assert flow.spin_rate < 1e-18


def test_lobes_that_orbit_without_spin_shear() -> None:
    signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * 3)).reshape(3, -1).T
    lobe = np.concatenate([POINTS * sign for sign in signs])
    d, s_squared = 3e5, float(np.mean(lobe[:, 0] ** 2))
    centre = np.array([d, 0.0, 0.0])
    position = np.concatenate([lobe + centre, lobe - centre])
    velocity = 1e-4 * d * np.sign(position[:, [0]]) * np.array([0.0, 1.0, 0.0])
    flow = linear_flow(position, velocity, np.ones(len(position)))
    # sum m v x^T = M omega d^2 in yx, sum m x x^T = M (d^2 + s^2) in xx, all else of v vanishes.
    fraction = d**2 / (d**2 + s_squared)
    np.testing.assert_allclose([flow.spin_rate, flow.strain_rate], 0.5e-4 * fraction, rtol=1e-10)
    np.testing.assert_allclose(flow.residual, np.sqrt(1.0 - fraction), rtol=1e-10)


def test_the_residual_does_not_depend_on_the_frame() -> None:
    velocity = np.random.default_rng(2).normal(size=POINTS.shape) + np.cross(OMEGA, POINTS)
    still, moving = (linear_flow(POINTS + 7.0 * u, velocity + u, MASS) for u in (np.zeros(3), np.array([500.0, 1, 2])))
    np.testing.assert_allclose(moving.residual, still.residual, rtol=1e-9)
    np.testing.assert_allclose(moving.gradient, still.gradient, rtol=1e-9)
    assert 0.0 < still.residual < 1.0


def test_at_rest_nothing_is_left_over() -> None:
    flow = linear_flow(POINTS, np.full_like(POINTS, 200.0), MASS)
    assert np.isnan(flow.residual) and flow.spin_rate < 1e-15 and abs(flow.strain_rate) < 1e-15


@pytest.mark.parametrize("extent", [[0.0, 0.0, 0.0], [1e5, 0.0, 0.0], [1e5, 5e4, 0.0]])
def test_particles_in_one_plane_have_no_gradient(extent: list[float]) -> None:
    points = np.random.default_rng(3).uniform(-1.0, 1.0, (20, 3)) * extent
    flow = linear_flow(points, np.cross(OMEGA, points) + 1.0, np.ones(20))
    assert np.isnan([flow.spin_rate, flow.strain_rate, flow.residual]).all()
