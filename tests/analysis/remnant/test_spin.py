"""Rotation of rigid bodies of particles, and where it is undefined."""

import numpy as np

from analysis.remnant.spin import angular_velocity, spin_period
from tests.helpers.fake_jobs import lattice_ellipsoid

OMEGA = np.array([1e-4, -2e-4, 3e-4])


def test_a_rigid_rotator_has_its_angular_velocity_wherever_it_goes() -> None:
    points, _ = lattice_ellipsoid((2e5, 1e5, 8e4), 500)
    mass = np.random.default_rng(0).uniform(1.0, 2.0, len(points))
    velocity = np.cross(OMEGA, points) + np.array([300.0, -20.0, 5.0])
    moved = points + np.array([1e6, 0.0, -1e6])
    np.testing.assert_allclose(angular_velocity(moved, velocity, mass), OMEGA, rtol=1e-9)
    np.testing.assert_allclose(spin_period(moved, velocity, mass), 2.0 * np.pi / np.linalg.norm(OMEGA), rtol=1e-9)


def test_expansion_is_no_rotation() -> None:
    points, _ = lattice_ellipsoid((2e5, 1e5, 8e4), 500)
    mass = np.ones(len(points))
    assert np.isnan(spin_period(points, 1e-3 * points + 100.0, mass))


def test_no_period_at_rest_or_for_points_on_a_line() -> None:
    points, _ = lattice_ellipsoid((2e5, 1e5, 8e4), 500)
    assert np.isnan(spin_period(points, np.full_like(points, 200.0), np.ones(len(points))))
    for count in (1, 2, 5):
        line = np.linspace(0.0, 1e5, count)[:, None] * np.array([1.0, 0.5, 0.2])
        assert np.isnan(spin_period(line, np.cross(OMEGA, line), np.ones(count)))
