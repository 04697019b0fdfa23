import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from analysis.remnant.filled import filled_volume
from tests.helpers.fake_jobs import lattice_ellipsoid


@pytest.mark.parametrize(
    ("axes", "count", "missing"),
    [((1e5, 1e5, 1e5), 500, 0.035), ((1e5, 1e5, 1e5), 5000, 0.015), ((4e5, 1e5, 3e4), 2000, 0.09)],
)
def test_a_lattice_fills_its_ellipsoid_but_for_the_error_of_the_surface(axes, count, missing):
    points, h = lattice_ellipsoid(axes, count)
    assert 1.0 - missing < filled_volume(points, h) / (len(points) * h**3) < 1.05


@pytest.mark.parametrize("ratios", [(1.0, 1.0, 1.0), (1.0, 0.93, 0.24), (1.0, 0.2, 0.13)])
def test_particles_at_random_fill_as_much_as_a_lattice(ratios):
    """Gaps that random places leave are pores: with balls of one spacing the volume would be 20 % too small."""
    count = 2000
    axes = np.array(ratios) * (3.0 * count / (4.0 * np.pi * np.prod(ratios))) ** (1.0 / 3.0)
    places = np.random.default_rng(1).normal(size=(count, 3))
    places *= np.random.default_rng(2).uniform(size=(count, 1)) ** (1.0 / 3.0) / np.linalg.norm(places, axis=1)[:, None]
    assert filled_volume(axes * places, 1.0) / count == pytest.approx(1.0, abs=0.05)


def test_the_volume_does_not_depend_on_place_and_direction():
    points, h = lattice_ellipsoid((2e5, 1e5, 5e4), 2000)
    turns = Rotation.from_euler("xyz", [[0.3, 1.0, 2.0], [1.0, -0.4, 0.2], [2.0, 0.7, -1.3]])
    found = [filled_volume(turn.apply(points) + 1e7 * i, h) for i, turn in enumerate(turns)]
    np.testing.assert_allclose(found, found[0], rtol=0.015)


def test_the_space_between_two_spheres_is_not_filled():
    points, h = lattice_ellipsoid((1e5, 1e5, 1e5), 1000)
    both = np.concatenate([points, points + np.array([1.4e5, 0.0, 0.0])])
    assert filled_volume(both, h) == pytest.approx(2.0 * filled_volume(points, h), rel=0.01)


def test_pores_smaller_than_a_particle_are_filled():
    points, h = lattice_ellipsoid((1e5, 1e5, 1e5), 5000)
    kept = points[np.random.default_rng(1).random(len(points)) > 0.1]
    assert filled_volume(kept, h) == pytest.approx(filled_volume(points, h), rel=0.04)


def test_one_particle_fills_about_its_own_volume():
    assert 0.3 < filled_volume(np.zeros((1, 3)), 2.0) / 8.0 < 1.0
