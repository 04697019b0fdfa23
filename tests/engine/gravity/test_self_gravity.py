import numpy as np
import pytest

from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.scene.placement import sphere_points
from engine.state.particles import Particles
from tests.helpers.device import Array, worst

pytestmark = pytest.mark.usefixtures("taichi")

G_N = 6.6743e-11


def lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt((vectors**2).sum(axis=1)))


def gravity_of(x: Array, mass: Array, radius: float, v: Array | None = None) -> DirectSum:
    return DirectSum(at(x, mass, v), radius)


def at(x: Array, mass: Array, v: Array | None = None) -> Particles:
    particles = Particles(len(x))
    particles.write({"x": x, "mass": mass, "v": np.zeros_like(x) if v is None else v})
    return particles


def cloud(count: int) -> tuple[Array, Array]:
    generator = np.random.default_rng(1)
    return 1e4 * generator.normal(size=(count, 3)), 1e12 * generator.uniform(0.1, 10.0, count)


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
    assert worst(gravity.pull(0.0), a, lengths(a).max()) < 1e-13
    energy = 0.5 * (mass * potential).sum()
    # each particle's own share, taken out again, is as large as 1.5 G m^2 / radius
    own = 1.5 * G_N * (mass**2).sum() / radius
    assert gravity.energy() == pytest.approx(energy, rel=1e-13, abs=1e-15 * own)


def test_pull_is_taken_ahead_of_now():
    x, mass = cloud(80)
    v = 10.0 * np.random.default_rng(2).normal(size=x.shape)
    ahead = gravity_of(x, mass, 1e3, v).pull(100.0)
    assert np.array_equal(ahead, gravity_of(x + 100.0 * v, mass, 1e3).pull(0.0))


def test_accelerations_have_no_net_force_and_no_net_torque():
    x, mass = cloud(700)
    gravity = gravity_of(x, mass, 1e3)
    gravity.accelerate(0.0)
    force = mass[:, None] * gravity.particles.read("acceleration")["acceleration"]
    assert lengths(force.sum(axis=0)[None])[0] < 1e-15 * lengths(force).sum()
    torque = np.cross(x, force)
    assert lengths(torque.sum(axis=0)[None])[0] < 1e-15 * (lengths(x) * lengths(force)).sum()


def energy_at(gravity: DirectSum, x: Array) -> float:
    gravity.particles.write({"x": x})
    return gravity.energy()


def test_forces_are_the_slope_of_the_energy():
    x, mass = cloud(40)
    gravity = gravity_of(x, mass, 1e4)
    pull = gravity.pull(0.0)
    for axis in range(3):
        step = np.zeros_like(x)
        step[7, axis] = 1.0
        after, before = (energy_at(gravity, x + sign * step) for sign in (1.0, -1.0))
        # a metre of 10 km: truncation and the round-off of the energy are both near 1e-8
        assert -(after - before) / 2.0 == pytest.approx(mass[7] * pull[7, axis], abs=1e-6 * mass[7] * lengths(pull)[7])


@pytest.mark.parametrize("opening", [0.0, 0.4])
def test_a_homogeneous_sphere_pulls_linearly_inside_and_as_a_point_outside(opening):
    R, rho, count = 50e3, 2700.0, 4000
    M, h = rho * 4.0 / 3.0 * np.pi * R**3, R * (4.0 / 3.0 * np.pi / count) ** (1.0 / 3.0)
    sphere = sphere_points(count, R, np.random.default_rng(1))
    generator = np.random.default_rng(2)
    probes = generator.normal(size=(400, 3))
    r = np.concatenate([np.linspace(0.1, 0.9, 200), np.linspace(1.3, 6.0, 200)]) * R
    probes *= (r / lengths(probes))[:, None]
    x = np.concatenate([sphere, probes])
    mass = np.concatenate([np.full(count, M / count), np.zeros(400)])
    solver = BarnesHut(at(x, mass), h, opening) if opening else DirectSum(at(x, mass), h)
    a = solver.pull(0.0)[count:]
    expected = -G_N * M * probes / np.maximum(r, R)[:, None] ** 3
    inside, outside = r < R, r > R
    # the lattice shows inside as a few hundredths of the surface gravity, and outside as a quadrupole, centred as it is
    surface = G_N * M / R**2
    assert worst(a[inside], expected[inside], surface) < 0.05
    assert np.sqrt(((a - expected)[inside] ** 2).sum(axis=1).mean()) < 0.015 * surface
    assert worst(a[outside], expected[outside], lengths(expected[outside]) * (R / r[outside]) ** 2) < 0.015


def test_energy_of_a_homogeneous_sphere():
    R, rho, count = 50e3, 2700.0, 4000
    M, h = rho * 4.0 / 3.0 * np.pi * R**3, R * (4.0 / 3.0 * np.pi / count) ** (1.0 / 3.0)
    x = sphere_points(count, R, np.random.default_rng(1))
    # a ball of radius h overlaps its neighbours: softening takes up to (h/R)^2 = 1 % away
    assert gravity_of(x, np.full(count, M / count), h).energy() == pytest.approx(-0.6 * G_N * M**2 / R, rel=0.01)


def test_two_particles_pull_each_other_as_newton_says():
    x = np.array([[0.0, 0.0, 0.0], [0.0, 3e3, 4e3]])
    gravity = gravity_of(x, np.array([1e15, 2e15]), 1e3)
    towards = np.array([0.0, 0.6, 0.8]) * G_N / 25e6
    assert worst(gravity.pull(0.0), np.array([2e15 * towards, -1e15 * towards]), 5e-3) < 1e-15
    assert gravity.energy() == pytest.approx(-G_N * 2e30 / 5e3, rel=1e-14)


def test_one_particle_does_not_pull_itself():
    gravity = gravity_of(np.array([[1e6, -2e6, 3e6]]), np.array([1e18]), 1e3)
    gravity.accelerate(5.0)
    assert not gravity.particles.read("acceleration")["acceleration"].any()
    assert abs(gravity.energy()) < 1e-15 * G_N * 1e36 / 1e3


def test_coincident_particles_do_not_pull_each_other():
    gravity = gravity_of(np.ones((3, 3)), np.array([1e15, 1e15, 2e15]), 1e3)
    assert not gravity.pull(0.0).any()
    assert gravity.energy() == pytest.approx(-1.5 * G_N * (1.0 + 2.0 + 2.0) * 1e30 / 1e3, rel=1e-14)
