"""The tree against the sum over all pairs."""

import numpy as np
import pytest

import engine.gravity.barnes_hut
from engine.constants import G_NEWTON
from engine.device import backend
from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.scene.placement import sphere_points
from engine.scene.scene import Gravity
from tests.helpers.device import Array
from tests.helpers.gravity import accelerations, energy, opened, particles_at, relative_error

pytestmark = pytest.mark.usefixtures("taichi")

RADIUS = 0.02
"""Of the ball that stands for a particle, for points in a volume of size one."""


def uniform(count: int) -> Array:
    return sphere_points(count, 1.0, np.random.default_rng(3))


def clustered(count: int) -> Array:
    """Clumps of 10 km, as far apart as fragments late in a collision are: 10,000 km. Lengths in units of 10 km."""
    generator = np.random.default_rng(4)
    centres = generator.normal(scale=1e3, size=(5, 3))
    return centres[generator.integers(5, size=count)] + 0.3 * generator.normal(size=(count, 3))


@pytest.mark.parametrize("points", [uniform, clustered])
def test_a_vanishing_opening_gives_the_sum_over_all_pairs(points) -> None:
    particles = particles_at(points(1500))
    exact = accelerations(DirectSum(particles, RADIUS))
    tree = BarnesHut(particles, RADIUS, 1e-9)
    assert relative_error(tree, exact).max() < 1e-11
    assert relative_error(opened(tree, 0.5), exact).max() > 1e-5


@pytest.mark.parametrize("points", [uniform, clustered])
def test_the_default_opening_is_right_to_half_a_percent(points) -> None:
    particles = particles_at(points(4000))
    exact = accelerations(DirectSum(particles, RADIUS))
    assert np.percentile(relative_error(BarnesHut(particles, RADIUS, Gravity().opening), exact), 99) < 5e-3


def test_one_and_two_threads_give_the_same_bits() -> None:
    results = []
    for threads in (1, 2):
        backend.start(threads=threads)
        tree = BarnesHut(particles_at(clustered(3000)), RADIUS, 0.4)
        results.append((accelerations(tree), energy(tree)))
    assert np.array_equal(results[0][0], results[1][0])
    assert results[0][1] == results[1][1]


def test_nodes_are_collected_in_batches_of_any_size(monkeypatch) -> None:
    particles = particles_at(uniform(3000))
    usual = accelerations(BarnesHut(particles, RADIUS, 0.3))
    for batch in (1, 7, 4096):
        monkeypatch.setattr(engine.gravity.barnes_hut, "BATCH", batch)
        np.testing.assert_allclose(accelerations(BarnesHut(particles, RADIUS, 0.3)), usual, rtol=1e-12, atol=1e-12)


def test_the_energy_agrees_with_the_sum_over_all_pairs() -> None:
    particles = particles_at(clustered(3000))
    assert energy(BarnesHut(particles, RADIUS, 0.5)) == pytest.approx(energy(DirectSum(particles, RADIUS)), rel=2e-4)


@pytest.mark.parametrize("count", [1, 2, 3, 15, 16, 17, 100])
def test_any_number_of_particles_will_do(count: int) -> None:
    particles = particles_at(np.random.default_rng(count).normal(size=(count, 3)))
    exact = accelerations(DirectSum(particles, RADIUS))
    np.testing.assert_allclose(accelerations(BarnesHut(particles, RADIUS, 1e-9)), exact, rtol=1e-11, atol=1e-12)


def test_particles_in_one_place_or_in_a_line_will_do() -> None:
    line = np.outer(np.linspace(-1.0, 1.0, 300) ** 3, [1.0, 0.0, 0.0])
    particles = particles_at(line)
    pairs, tree = DirectSum(particles, RADIUS), BarnesHut(particles, RADIUS, 1.0)
    for x in (np.ones((300, 3)), np.concatenate([np.zeros((150, 3)), np.ones((150, 3))]), line):
        particles.write({"x": x})
        exact = accelerations(pairs)
        np.testing.assert_allclose(accelerations(opened(tree, 1e-9)), exact, rtol=1e-11, atol=1e-10)
        difference = np.abs(accelerations(opened(tree, 0.5)) - exact)
        assert np.median(difference) <= 5e-3 * np.abs(exact).mean()


def test_unequal_masses_keep_their_weight() -> None:
    x = uniform(2000)
    particles = particles_at(x, np.random.default_rng(5).uniform(0.1, 100.0, 2000) / G_NEWTON)
    exact = accelerations(DirectSum(particles, RADIUS))
    assert np.percentile(relative_error(BarnesHut(particles, RADIUS, 0.5), exact), 99) < 5e-3


def test_gravity_adds_no_momentum_and_no_angular_momentum() -> None:
    particles = particles_at(clustered(1000))
    taken_out = BarnesHut(particles, RADIUS, 0.8).accelerate(0.0)
    assert 1e-8 < taken_out.force < 1e-2 and 1e-8 < taken_out.torque < 1e-2
    state = particles.read("x", "acceleration", "mass")
    force = state["mass"][:, None] * state["acceleration"]
    assert np.abs(force.sum(axis=0)).max() < 1e-13 * np.abs(force).sum()
    torque = np.cross(state["x"], force)
    assert np.abs(torque.sum(axis=0)).max() < 1e-13 * np.abs(torque).sum()
