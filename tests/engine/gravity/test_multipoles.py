"""Nodes that act by monopole and quadrupole: the order of what is left out."""

import numpy as np
import pytest

from engine.constants import G_NEWTON
from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.gravity.self_gravity import SelfGravity
from engine.scene.placement import sphere_points
from tests.helpers.device import Array
from tests.helpers.gravity import accelerations, opened, particles_at, relative_error
from tests.helpers.monopoles import Monopoles

pytestmark = pytest.mark.usefixtures("taichi")

RADIUS = 0.02
"""Of the ball that stands for a particle, for points in a volume of size one."""


def sphere(count: int) -> Array:
    return sphere_points(count, 1.0, np.random.default_rng(3))


def test_every_node_has_the_mass_centre_and_quadrupole_of_its_particles() -> None:
    """The first two levels, from all particles of their half of the slots; units are those of the solver."""
    generator = np.random.default_rng(1)
    x, mass = generator.normal(size=(500, 3)), generator.uniform(1.0, 3.0, 500)
    tree = BarnesHut(particles_at(x, mass), RADIUS, 0.5)
    tree.accelerations(x, mass)
    slots = np.stack([field.to_numpy()[: tree.room << tree.depth] for field in (tree.x, tree.y, tree.z)], axis=1)
    gm = tree.gm.to_numpy()[: tree.room << tree.depth]
    centres, quadrupoles = tree.centre.to_numpy(), tree.quadrupole.to_numpy()
    lower, upper = tree.lower.to_numpy(), tree.upper.to_numpy()
    for node, part in ((1, slice(None)), (2, slice(None, len(gm) // 2)), (3, slice(len(gm) // 2, None))):
        centre = np.average(slots[part], axis=0, weights=gm[part])
        d = slots[part] - centre
        Q = np.einsum("p,pi,pj->ij", gm[part], 3.0 * d, d) - (gm[part] * (d**2).sum(axis=1)).sum() * np.eye(3)
        np.testing.assert_allclose(centres[node], [*centre, gm[part].sum()], rtol=1e-12, atol=1e-14)
        six = Q[[0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]]
        np.testing.assert_allclose(quadrupoles[node], six, rtol=1e-11, atol=1e-12 * np.abs(Q).max())
        box = [slots[part].min(axis=0), slots[part].max(axis=0)]
        assert np.array_equal([lower[node], upper[node]], box)


@pytest.mark.parametrize(("solver", "order"), [(Monopoles, 2.0), (BarnesHut, 3.0)])
def test_the_error_falls_with_the_first_power_of_the_opening_that_is_left_out(solver, order) -> None:
    """About the centre of mass a monopole leaves the quadrupole, second order in size over distance, and so on."""
    particles = particles_at(sphere(16000))
    exact = accelerations(DirectSum(particles, RADIUS))
    tree, openings = solver(particles, RADIUS, 1.0), np.array([0.3, 0.4, 0.5, 0.6])
    errors = [float(np.median(relative_error(opened(tree, opening), exact))) for opening in openings]
    fitted = np.polyfit(np.log(openings), np.log(errors), 1)[0]
    assert order - 0.3 < fitted < order + 1.2


@pytest.mark.parametrize(("solver", "order"), [(Monopoles, 2.0), (BarnesHut, 3.0)])
def test_a_cloud_that_acts_as_one_node_is_wrong_by_the_first_moment_left_out(solver, order) -> None:
    generator = np.random.default_rng(6)
    cloud, probes = generator.exponential(size=(512, 3)) * [1.0, 1.0, 3.0], generator.uniform(-1.0, 1.0, (512, 3))
    mass = np.concatenate([np.ones(512), np.zeros(512)]) / G_NEWTON
    distances = np.array([300.0, 600.0, 1200.0])
    particles = particles_at(np.concatenate([cloud, probes]), mass)
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


def pull_and_potential(solver: SelfGravity) -> tuple[Array, Array]:
    state = solver.particles.read("x", "mass")
    return accelerations(solver), solver.potentials(state["x"], state["mass"])


def test_the_quadrupole_earns_its_place() -> None:
    particles = particles_at(sphere(4000))
    exact = accelerations(DirectSum(particles, RADIUS))
    with_it, without = (
        np.median(relative_error(solver(particles, RADIUS, 0.5), exact)) for solver in (BarnesHut, Monopoles)
    )
    assert with_it < 0.3 * without
