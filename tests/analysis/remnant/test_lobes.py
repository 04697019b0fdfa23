import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from analysis.remnant.lobes import lobes_of
from tests.helpers.fake_jobs import lattice_ellipsoid

X = np.array([1.0, 0.0, 0.0])


def spheres(*gaps: float) -> tuple[np.ndarray, float]:
    """Equal spheres in a row, gaps between their surfaces in radii; 1,000 particles each."""
    points, h = lattice_ellipsoid((2.0, 2.0, 2.0), 1000)
    places = np.cumsum([0.0, *(2.0 + gap for gap in gaps)])
    return np.concatenate([points + place * X for place in places]), h


@pytest.mark.parametrize("axes", [(2.0, 2.0, 2.0), (8.0, 2.0, 0.5), (8.0, 1.0, 1.0)])
def test_an_ellipsoid_has_one_lobe(axes):
    points, h = lattice_ellipsoid(axes, 2000)
    found = lobes_of(points, np.ones(len(points)), X, h)
    assert found.count == 1 and found.mass[0] == len(points)


def test_a_rod_has_one_lobe():
    rod = np.stack(np.meshgrid(np.arange(40), np.arange(6), np.arange(6), indexing="ij"), axis=-1).reshape(-1, 3)
    assert lobes_of(rod.astype(float), np.ones(len(rod)), X, 1.0).count == 1


@pytest.mark.parametrize("gap", [-0.3, 0.0, 0.2])
def test_two_spheres_are_two_lobes_of_half_the_mass(gap):
    points, h = spheres(gap)
    turn = Rotation.from_euler("xyz", [0.3, 1.0, 2.0])
    found = lobes_of(turn.apply(points) + 100.0, np.ones(len(points)), turn.apply(X), h)
    assert found.count == 2
    np.testing.assert_allclose(found.mass, 0.5 * len(points), rtol=0.03)


def test_overlapping_spheres_without_a_neck_are_one_lobe():
    assert lobes_of(*_weighted(spheres(-1.0))).count == 1


def test_three_spheres_are_three_lobes():
    assert lobes_of(*_weighted(spheres(0.0, 0.0))).count == 3


def test_one_particle_is_one_lobe():
    found = lobes_of(np.zeros((1, 3)), np.array([3.0]), X, 1.0)
    assert found.count == 1 and found.mass[0] == 3.0


def _weighted(row: tuple[np.ndarray, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    points, h = row
    return points, np.ones(len(points)), X, h
