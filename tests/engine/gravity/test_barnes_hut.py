"""The tree against the sum over all pairs."""

import numpy as np
import pytest

import engine.gravity.barnes_hut
from engine.constants import G_NEWTON
from engine.device import backend
from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.gravity.self_gravity import SelfGravity
from engine.scene.placement import sphere_points
from engine.scene.scene import Gravity
from engine.state.particles import Particles
from tests.helpers.device import Array
from tests.helpers.monopoles import Monopoles

pytestmark = pytest.mark.usefixtures("taichi")

RADIUS = 0.02
"""Of the ball that stands for a particle, for points in a volume of size one."""


def with_particles(x: Array, mass: Array | None = None) -> Particles:
    particles = Particles(len(x))
    particles.write({"x": x, "mass": np.ones(len(x)) / G_NEWTON if mass is None else mass, "v": np.zeros_like(x)})
    return particles


def error(gravity: SelfGravity, exact: Array) -> Array:
    """Relative error of every acceleration."""
    return np.asarray(np.linalg.norm(gravity.pull(0.0) - exact, axis=1) / np.linalg.norm(exact, axis=1))


def opened(tree: BarnesHut, opening: float) -> BarnesHut:
    """The same tree with another opening angle [-]: its kernels are compiled already."""
    tree.opening[None] = opening
    return tree


def uniform(count: int) -> Array:
    return sphere_points(count, 1.0, np.random.default_rng(3))


def clustered(count: int) -> Array:
    """Clumps of 10 km, as far apart as fragments late in a collision are: 10,000 km. Lengths in units of 10 km."""
    generator = np.random.default_rng(4)
    centres = generator.normal(scale=1e3, size=(5, 3))
    return centres[generator.integers(5, size=count)] + 0.3 * generator.normal(size=(count, 3))


@pytest.mark.parametrize("points", [uniform, clustered])
def test_a_vanishing_opening_gives_the_sum_over_all_pairs(points) -> None:
    particles = with_particles(points(1500))
    exact = DirectSum(particles, RADIUS).pull(0.0)
    tree = BarnesHut(particles, RADIUS, 1e-9)
    assert error(tree, exact).max() < 1e-11
    assert error(opened(tree, 0.5), exact).max() > 1e-5


@pytest.mark.parametrize("points", [uniform, clustered])
def test_the_default_opening_is_right_to_half_a_percent(points) -> None:
    particles = with_particles(points(4000))
    exact = DirectSum(particles, RADIUS).pull(0.0)
    assert np.percentile(error(BarnesHut(particles, RADIUS, Gravity().opening), exact), 99) < 5e-3


@pytest.mark.parametrize(("solver", "order"), [(Monopoles, 2.0), (BarnesHut, 3.0)])
def test_the_error_falls_with_the_first_power_of_the_opening_that_is_left_out(solver, order) -> None:
    """About the centre of mass a monopole leaves the quadrupole, second order in size over distance, and so on."""
    particles = with_particles(uniform(16000))
    exact = DirectSum(particles, RADIUS).pull(0.0)
    tree, openings = solver(particles, RADIUS, 1.0), np.array([0.3, 0.4, 0.5, 0.6])
    errors = [float(np.median(error(opened(tree, opening), exact))) for opening in openings]
    fitted = np.polyfit(np.log(openings), np.log(errors), 1)[0]
    assert order - 0.3 < fitted < order + 1.2


@pytest.mark.parametrize(("solver", "order"), [(Monopoles, 2.0), (BarnesHut, 3.0)])
def test_a_cloud_that_acts_as_one_node_is_wrong_by_the_first_moment_left_out(solver, order) -> None:
    generator = np.random.default_rng(6)
    cloud, probes = generator.exponential(size=(512, 3)) * [1.0, 1.0, 3.0], generator.uniform(-1.0, 1.0, (512, 3))
    mass = np.concatenate([np.ones(512), np.zeros(512)]) / G_NEWTON
    distances = np.array([300.0, 600.0, 1200.0])
    particles = with_particles(np.zeros((1024, 3)), mass)
    solvers = (DirectSum(particles, RADIUS), solver(particles, RADIUS, 1.0))
    errors = []
    for distance in distances:
        particles.write({"x": np.concatenate([cloud, probes + np.array([0.0, 0.0, distance])])})
        exact, tree = (pull_and_potential(gravity) for gravity in solvers)
        errors.append(
            [np.linalg.norm(t[512:] - e[512:]) / np.linalg.norm(e[512:]) for t, e in zip(tree, exact, strict=True)]
        )
    slopes = np.polyfit(np.log(distances), np.log(errors), 1)[0]
    assert -slopes == pytest.approx(order, abs=0.1)


def pull_and_potential(gravity: SelfGravity) -> tuple[Array, Array]:
    """Accelerations, and the potentials that made the energy, in the solver's unit, which depends on the particles."""
    gravity.energy()
    particle, potential = gravity.arrange(gravity.particles.read("x")["x"]), np.empty(gravity.count)
    slots = np.flatnonzero(particle >= 0)
    potential[particle[slots]] = gravity.potential.to_numpy()[slots]
    return gravity.pull(0.0), potential


def test_the_quadrupole_earns_its_place() -> None:
    particles = with_particles(uniform(4000))
    exact = DirectSum(particles, RADIUS).pull(0.0)
    with_it, without = (np.median(error(solver(particles, RADIUS, 0.5), exact)) for solver in (BarnesHut, Monopoles))
    assert with_it < 0.3 * without


def test_one_and_two_threads_give_the_same_bits() -> None:
    results = []
    for threads in (1, 2):
        backend.start(threads=threads)
        tree = BarnesHut(with_particles(clustered(3000)), RADIUS, 0.4)
        results.append((tree.pull(0.0), tree.energy()))
    assert np.array_equal(results[0][0], results[1][0])
    assert results[0][1] == results[1][1]


def test_nodes_are_collected_in_batches_of_any_size(monkeypatch) -> None:
    particles = with_particles(uniform(3000))
    usual = BarnesHut(particles, RADIUS, 0.3).pull(0.0)
    for batch in (1, 7, 4096):
        monkeypatch.setattr(engine.gravity.barnes_hut, "BATCH", batch)
        np.testing.assert_allclose(BarnesHut(particles, RADIUS, 0.3).pull(0.0), usual, rtol=1e-12, atol=1e-12)


def test_the_energy_agrees_with_the_sum_over_all_pairs() -> None:
    particles = with_particles(clustered(3000))
    assert BarnesHut(particles, RADIUS, 0.5).energy() == pytest.approx(DirectSum(particles, RADIUS).energy(), rel=2e-4)


@pytest.mark.parametrize("count", [1, 2, 3, 15, 16, 17, 100])
def test_any_number_of_particles_will_do(count: int) -> None:
    particles = with_particles(np.random.default_rng(count).normal(size=(count, 3)))
    exact = DirectSum(particles, RADIUS).pull(0.0)
    np.testing.assert_allclose(BarnesHut(particles, RADIUS, 1e-9).pull(0.0), exact, rtol=1e-11, atol=1e-12)


def test_particles_in_one_place_or_in_a_line_will_do() -> None:
    line = np.outer(np.linspace(-1.0, 1.0, 300) ** 3, [1.0, 0.0, 0.0])
    particles = with_particles(line)
    pairs, tree = DirectSum(particles, RADIUS), BarnesHut(particles, RADIUS, 1.0)
    for x in (np.ones((300, 3)), np.concatenate([np.zeros((150, 3)), np.ones((150, 3))]), line):
        particles.write({"x": x})
        exact = pairs.pull(0.0)
        np.testing.assert_allclose(opened(tree, 1e-9).pull(0.0), exact, rtol=1e-11, atol=1e-10)
        difference = np.abs(opened(tree, 0.5).pull(0.0) - exact)
        assert np.median(difference) <= 5e-3 * np.abs(exact).mean()


def test_unequal_masses_keep_their_weight() -> None:
    x = uniform(2000)
    particles = with_particles(x, np.random.default_rng(5).uniform(0.1, 100.0, 2000) / G_NEWTON)
    exact = DirectSum(particles, RADIUS).pull(0.0)
    assert np.percentile(error(BarnesHut(particles, RADIUS, 0.5), exact), 99) < 5e-3


def test_gravity_adds_no_momentum_and_no_angular_momentum() -> None:
    particles = with_particles(clustered(1000))
    taken_out = BarnesHut(particles, RADIUS, 0.8).accelerate(0.0)
    assert 1e-8 < taken_out.force < 1e-2 and 1e-8 < taken_out.torque < 1e-2
    state = particles.read("x", "acceleration", "mass")
    force = state["mass"][:, None] * state["acceleration"]
    assert np.abs(force.sum(axis=0)).max() < 1e-13 * np.abs(force).sum()
    torque = np.cross(state["x"], force)
    assert np.abs(torque.sum(axis=0)).max() < 1e-13 * np.abs(torque).sum()
