"""The ellipsoid of a clump against bodies of known shape."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from analysis.remnant.ellipsoid import bulk_density, ellipsoid_of, kurtosis
from tests.helpers.fake_jobs import RHO0, lattice_ellipsoid

ratio = st.floats(0.15, 1.0)


@settings(max_examples=25, deadline=None)
@given(b=ratio, c=ratio, seed=st.integers(0, 10**6))
def test_axes_of_a_lattice_filled_ellipsoid_in_any_position(b: float, c: float, seed: int) -> None:
    axes = np.sort([1.5e5, 1.5e5 * b, 1.5e5 * c])[::-1]
    points, spacing = lattice_ellipsoid((axes[0], axes[1], axes[2]), 4000, seed)
    turned = Rotation.random(random_state=seed).apply(points) + np.array([3e6, -2e6, 1e5])
    mass = np.full(len(points), RHO0 * spacing**3)
    found = ellipsoid_of(turned, mass)
    # The surface of a lattice body is rough by a share of a spacing, independently over its area.
    np.testing.assert_allclose(found.axes, axes, rtol=(spacing / axes[2]) ** 1.5)
    np.testing.assert_allclose(
        bulk_density(float(mass.sum()), found.volume), RHO0, rtol=2.0 * (spacing / axes[2]) ** 1.5
    )


def test_principal_directions_are_those_of_the_body() -> None:
    points, _ = lattice_ellipsoid((4.0, 2.0, 1.0), 4000)
    turn = Rotation.from_euler("xyz", [0.3, -0.7, 1.1])
    found = ellipsoid_of(turn.apply(points), np.ones(len(points)))
    np.testing.assert_allclose(np.abs(found.directions @ turn.as_matrix()), np.eye(3), atol=0.03)
    np.testing.assert_allclose(np.linalg.det(found.directions), 1.0)


def test_six_points_have_the_axes_of_the_formula() -> None:
    points = np.concatenate([np.diag([3.0, 2.0, 1.0]), -np.diag([3.0, 2.0, 1.0])])
    # I1 + I2 - I3 = 2 sum m x^2 along each axis, with sum m x^2 = 2 x^2 and M = 6.
    np.testing.assert_allclose(
        ellipsoid_of(points, np.ones(6)).axes, np.sqrt(10 * 2 * 2 / 6) * np.array([3.0, 2.0, 1.0])
    )


def test_a_sphere_is_round() -> None:
    points, _ = lattice_ellipsoid((1e5, 1e5, 1e5), 20000)
    found = ellipsoid_of(points, np.ones(len(points)))
    assert 0.99 < found.c_over_a <= found.b_over_a <= 1.0


def test_the_size_of_particles_adds_its_second_moment() -> None:
    points, spacing = lattice_ellipsoid((8.0, 4.0, 1.0), 500)
    mass = np.full(len(points), 7.0)
    thin, thick = ellipsoid_of(points, mass), ellipsoid_of(points, mass, spacing)
    np.testing.assert_allclose(thick.axes**2, thin.axes**2 + 20.0 * spacing**2 / 12.0)
    np.testing.assert_allclose(ellipsoid_of(np.zeros((1, 3)), np.ones(1), 3.0).axes, np.sqrt(20.0 / 12.0) * 3.0)


A_SPHERE = 15.0 / 7.0
TOUCHING_SPHERES = (1.0 + 6.0 / 5.0 + 3.0 / 35.0) / (1.0 + 1.0 / 5.0) ** 2
"""<(1 + u)^4>/<(1 + u)^2>^2 with <u^2> = 1/5 and <u^4> = 3/35 inside the unit sphere."""


def inside_ellipsoid(axes: list[float], count: int, seed: int = 0) -> np.ndarray:
    """Independent points, uniform inside an ellipsoid of full `axes`."""
    random = np.random.default_rng(seed)
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return 0.5 * np.array(axes) * direction * random.uniform(size=(count, 1)) ** (1.0 / 3.0)


def test_kurtosis_of_a_uniform_ellipsoid_is_the_same_in_every_direction() -> None:
    points = inside_ellipsoid([4.0, 2.0, 1.0], 200_000)
    turn = Rotation.from_euler("xyz", [0.3, -0.7, 1.1])
    for direction in (*np.eye(3), np.array([0.6, 0.0, 0.8])):
        found = kurtosis(turn.apply(points) + 1e2, np.ones(len(points)), turn.apply(direction))
        # The standard error of <x^4>/<x^2>^2 over independent points is 1.64/sqrt(count), by moments up to <x^8>.
        np.testing.assert_allclose(found, A_SPHERE, atol=4.0 * 1.64 / np.sqrt(len(points)))


def test_kurtosis_of_two_lobes_is_lower() -> None:
    x = np.array([1.0, 0.0, 0.0])
    assert kurtosis(np.array([x, -x]), np.ones(2), x) == 1.0
    sphere = inside_ellipsoid([2.0, 2.0, 2.0], 100_000)
    lobes = np.concatenate([sphere + x, sphere - x])
    np.testing.assert_allclose(kurtosis(lobes, np.ones(len(lobes)), x), TOUCHING_SPHERES, atol=0.01)
    np.testing.assert_allclose(kurtosis(np.linspace(-x, x, 10_001), np.ones(10_001), x), 9.0 / 5.0, rtol=1e-3)


def test_kurtosis_counts_mass_not_points() -> None:
    line = np.array([-1.0, 0.0, 1.0])[:, None] * np.array([0.6, 0.8, 0.0])
    # <x^4>/<x^2>^2 of 1, 0 and 1 with weights 1, 6 and 1: (2/8)/(2/8)^2
    np.testing.assert_allclose(kurtosis(line + 5.0, np.array([1.0, 6.0, 1.0]), np.array([0.6, 0.8, 0.0])), 4.0)


def test_touching_spheres_fill_part_of_their_ellipsoid() -> None:
    sphere = inside_ellipsoid([2.0, 2.0, 2.0], 100_000)
    x = np.array([1.0, 0.0, 0.0])
    found = ellipsoid_of(np.concatenate([sphere + x, sphere - x]), np.ones(2 * len(sphere)))
    np.testing.assert_allclose(8.0 / 3.0 * np.pi / found.volume, np.sqrt(2.0 / 3.0), rtol=0.01)


def test_one_point_has_no_shape() -> None:
    found = ellipsoid_of(np.array([[5.0, 6.0, 7.0]]), np.ones(1))
    assert found.axes.tolist() == [0.0, 0.0, 0.0]
    assert np.isnan([found.b_over_a, found.c_over_a, bulk_density(1.0, found.volume)]).all()
    assert np.isnan(kurtosis(np.array([[5.0, 6.0, 7.0]]), np.ones(1), found.directions[0]))


def test_points_on_a_line_and_in_a_plane_have_no_thickness() -> None:
    turn = Rotation.from_euler("xyz", [0.4, 1.0, -0.2])
    random = np.random.default_rng(2)
    for extent in ([1e5, 0, 0], [1e5, 5e4, 0]):
        points = turn.apply(random.uniform(-1.0, 1.0, (50, 3)) * extent) + 1e6
        found = ellipsoid_of(points, np.ones(50))
        assert found.c_over_a == 0.0
        assert (found.b_over_a > 0.0) == (extent[1] > 0.0)
        assert np.isnan(bulk_density(1.0, found.volume))
