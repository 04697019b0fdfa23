import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from engine.scene.placement import sphere_points

RADIUS = 50e3


def points(count: int, seed: int = 1) -> np.ndarray:
    return sphere_points(count, RADIUS, np.random.default_rng(seed))


def spacing(count: int) -> float:
    return float(RADIUS * (4.0 / 3.0 * np.pi / count) ** (1.0 / 3.0))


@given(count=st.integers(1, 5000), seed=st.integers(0, 2**32))
def test_a_sphere_has_exactly_the_points_asked_for_within_its_radius(count, seed):
    x = points(count, seed)
    assert x.shape == (count, 3)
    # the lattice ends where it has enough points; the last layer may stand out by a part of a spacing
    assert np.sqrt((x**2).sum(axis=1)).max() < RADIUS + 0.6 * spacing(count)
    assert np.abs(x.mean(axis=0)).max() < 1e-12 * RADIUS


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20, 1000, 5000])
def test_points_are_as_far_apart_as_in_a_face_centred_lattice(count):
    x = points(count)
    if count > 1:
        nearest = cKDTree(x).query(x, k=2)[0][:, 1]
        # a cube of side h 4^(1/3) contains four points, the nearest at 1/sqrt(2) of its side
        np.testing.assert_allclose(nearest, spacing(count) * 4.0 ** (1.0 / 3.0) / np.sqrt(2.0), rtol=1e-9)


@pytest.mark.parametrize("count", [1000, 5000, 20000])
def test_density_does_not_depend_on_the_radius(count):
    r = np.sort(np.sqrt((points(count) ** 2).sum(axis=1))) / RADIUS
    share = np.arange(1, count + 1) / count
    # the number of points in a ball deviates with its surface: by a layer of a tenth of the spacing
    assert np.abs(r**3 - share).max() < 3.0 * 0.1 * spacing(count) / RADIUS


@pytest.mark.parametrize("count", [1000, 20000])
def test_second_moments_are_those_of_a_ball_along_every_axis(count):
    moments = np.linalg.eigvalsh(points(count).T @ points(count) / count) / (RADIUS**2 / 5.0)
    assert np.abs(moments - 1.0).max() < 0.3 * spacing(count) / RADIUS


def test_no_axis_is_preferred_over_many_seeds():
    """Directions of the longest axis of many small spheres point everywhere alike."""
    longest = np.array([np.linalg.eigh(points(50, seed).T @ points(50, seed))[1][:, 2] for seed in range(300)])
    spread = np.linalg.eigvalsh(longest.T @ longest / 300)
    # uniform directions: each third with a standard deviation of sqrt(4/45/300) = 0.017
    assert np.abs(spread - 1.0 / 3.0).max() < 4.0 * 0.017


def test_a_sphere_scales_with_its_radius():
    twice = sphere_points(300, 2.0 * RADIUS, np.random.default_rng(1))
    np.testing.assert_allclose(twice, 2.0 * points(300), rtol=1e-15)


def test_same_seed_same_points_other_seed_other_points():
    assert np.array_equal(points(500, 1), points(500, 1))
    assert not np.allclose(np.sort(points(500, 1), axis=0), np.sort(points(500, 2), axis=0))
