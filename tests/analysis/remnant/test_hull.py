"""The convex hull: exact solids, agreement with the moments, and clouds without a hull."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from analysis.remnant.ellipsoid import ellipsoid_of
from analysis.remnant.hull import hull_of, hull_of_mesh
from tests.helpers.fake_jobs import lattice_ellipsoid


def test_a_box_is_measured_exactly() -> None:
    hull = hull_of_mesh(trimesh.creation.box(extents=[3.0, 2.0, 1.0]), scale=10.0)
    np.testing.assert_allclose(hull.volume, 6000.0)
    np.testing.assert_allclose(hull.extents, [30.0, 20.0, 10.0])
    # A box has the second moment M L^2/12, an ellipsoid M a^2/20.
    np.testing.assert_allclose(hull.ellipsoid.axes, np.sqrt(20.0 / 12.0) * np.array([30.0, 20.0, 10.0]))


def test_an_ellipsoid_mesh_has_the_axes_of_its_ellipsoid() -> None:
    mesh = trimesh.creation.icosphere(subdivisions=4)
    mesh.apply_scale([2.0, 1.2, 0.5])
    hull = hull_of_mesh(mesh)
    # Chords of 1,280 x 4 facets cut off less than half a percent.
    np.testing.assert_allclose(hull.ellipsoid.axes, [4.0, 2.4, 1.0], rtol=5e-3)
    np.testing.assert_allclose(hull.volume, np.pi / 6.0 * 4.0 * 2.4, rtol=1e-2)


@settings(max_examples=15, deadline=None)
@given(b=st.floats(0.3, 1.0), c=st.floats(0.3, 1.0), seed=st.integers(0, 10**6))
def test_hull_and_moments_agree_on_an_ellipsoid_of_particles(b: float, c: float, seed: int) -> None:
    points, spacing = lattice_ellipsoid((2e5, 2e5 * b, 2e5 * c), 4000, seed)
    turned = Rotation.random(random_state=seed).apply(points) + np.array([2e6, 1e6, -3e6])
    moments, hull = ellipsoid_of(turned, np.ones(len(points))), hull_of(turned)
    # The hull goes through the outermost particle centres, about half a spacing inside the surface on either side.
    np.testing.assert_allclose(hull.ellipsoid.axes, moments.axes, atol=1.2 * spacing)
    np.testing.assert_allclose(hull.extents, moments.axes, atol=2.5 * spacing)
    np.testing.assert_allclose(hull.volume, moments.volume, rtol=3.0 * spacing / moments.axes[2])


CLOUDS = {
    "one": np.ones((1, 3)),
    "two": np.array([[0.0, 0, 0], [1.0, 2.0, 3.0]]),
    "three": np.array([[0.0, 0, 0], [1.0, 2.0, 3.0], [0.0, 5.0, 0.0]]),
    "the same place": np.ones((9, 3)),
    "a line": np.linspace(0.0, 1.0, 20)[:, None] * np.array([1.0, 2.0, 3.0]),
    "a plane": np.random.default_rng(1).uniform(-1, 1, (30, 2)) @ np.array([[1.0, 2.0, 3.0], [0.3, 0.1, -1.0]]),
}


@pytest.mark.parametrize("cloud", CLOUDS)
@pytest.mark.parametrize("scale", [1.0, 1e5])
def test_clouds_without_volume_have_no_hull(cloud: str, scale: float) -> None:
    hull = hull_of(CLOUDS[cloud] * scale + 10.0 * scale)
    assert np.isnan([hull.volume, *hull.extents, hull.ellipsoid.b_over_a, hull.ellipsoid.c_over_a]).all()


def test_four_particles_have_a_hull() -> None:
    hull = hull_of(np.array([[0.0, 0, 0], [6e3, 0, 0], [0, 6e3, 0], [0, 0, 6e3]]))
    np.testing.assert_allclose(hull.volume, 6e3**3 / 6.0)
