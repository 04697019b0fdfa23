"""The sum over all pairs against one that is written out pair by pair."""

import numpy as np
import pytest

from engine.gravity.direct_sum import DirectSum
from tests.helpers.device import Array, worst
from tests.helpers.gravity import accelerations, cloud, energy, lengths, particles_at

pytestmark = pytest.mark.usefixtures("taichi")

G_N = 6.6743e-11


def gravity_of(x: Array, mass: Array, radius: float) -> DirectSum:
    return DirectSum(particles_at(x, mass), radius)


def pair_sum(x: Array, mass: Array, radius: float) -> tuple[Array, Array]:
    """Acceleration and potential in the field of homogeneous balls, pair by pair, without the particle itself."""
    a, potential = np.zeros_like(x), np.zeros(len(x))
    for p in range(len(x)):
        for q in range(len(x)):
            gap = x[q] - x[p]
            r = np.sqrt(gap @ gap)
            if p == q:
                continue
            if r < radius:
                a[p] += G_N * mass[q] * gap / radius**3
                potential[p] -= G_N * mass[q] * (3.0 * radius**2 - r**2) / (2.0 * radius**3)
            else:
                a[p] += G_N * mass[q] * gap / r**3
                potential[p] -= G_N * mass[q] / r
    return a, potential


@pytest.mark.parametrize("count", [2, 63, 64, 65, 150])
@pytest.mark.parametrize("radius", [1e-3, 1e4, 1e6])
def test_pull_and_energy_equal_the_sum_over_pairs(count, radius):
    x, mass = cloud(count)
    gravity = gravity_of(x, mass, radius)
    a, potential = pair_sum(x, mass, radius)
    assert worst(accelerations(gravity), a, lengths(a).max()) < 1e-13
    expected = 0.5 * (mass * potential).sum()
    # each particle's own share, taken out again, is as large as 1.5 G m^2 / radius
    own = 1.5 * G_N * (mass**2).sum() / radius
    assert energy(gravity) == pytest.approx(expected, rel=1e-13, abs=1e-15 * own)


def test_two_particles_pull_each_other_as_newton_says():
    x = np.array([[0.0, 0.0, 0.0], [0.0, 3e3, 4e3]])
    gravity = gravity_of(x, np.array([1e15, 2e15]), 1e3)
    towards = np.array([0.0, 0.6, 0.8]) * G_N / 25e6
    assert worst(accelerations(gravity), np.array([2e15 * towards, -1e15 * towards]), 5e-3) < 1e-15
    assert energy(gravity) == pytest.approx(-G_N * 2e30 / 5e3, rel=1e-14)


def test_one_particle_does_not_pull_itself():
    gravity = gravity_of(np.array([[1e6, -2e6, 3e6]]), np.array([1e18]), 1e3)
    gravity.accelerate(5.0)
    assert not gravity.particles.read("acceleration")["acceleration"].any()
    assert abs(energy(gravity)) < 1e-15 * G_N * 1e36 / 1e3


def test_coincident_particles_do_not_pull_each_other():
    gravity = gravity_of(np.ones((3, 3)), np.array([1e15, 1e15, 2e15]), 1e3)
    assert not accelerations(gravity).any()
    assert energy(gravity) == pytest.approx(-1.5 * G_N * (1.0 + 2.0 + 2.0) * 1e30 / 1e3, rel=1e-14)
