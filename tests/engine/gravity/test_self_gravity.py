"""Self-gravity, whichever way it is summed: what it removes, where it is taken, and a sphere."""

import numpy as np
import pytest

from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.scene.placement import sphere_points
from tests.helpers.device import Array, worst
from tests.helpers.gravity import accelerations, cloud, energy, energy_at, lengths, particles_at

pytestmark = pytest.mark.usefixtures("taichi")

G_N = 6.6743e-11


def gravity_of(x: Array, mass: Array, radius: float, v: Array | None = None) -> DirectSum:
    return DirectSum(particles_at(x, mass, v), radius)


def test_accelerations_are_those_ahead_of_now():
    x, mass = cloud(80)
    v = 10.0 * np.random.default_rng(2).normal(size=x.shape)
    moving, moved = gravity_of(x, mass, 1e3, v), gravity_of(x + 100.0 * v, mass, 1e3)
    moving.accelerate(100.0)
    moved.accelerate(0.0)
    ahead, expected = (solver.particles.read("acceleration")["acceleration"] for solver in (moving, moved))
    assert expected.any() and np.array_equal(ahead, expected)


def test_accelerations_have_no_net_force_and_no_net_torque():
    x, mass = cloud(700)
    gravity = gravity_of(x, mass, 1e3)
    gravity.accelerate(0.0)
    force = mass[:, None] * gravity.particles.read("acceleration")["acceleration"]
    assert lengths(force.sum(axis=0)[None])[0] < 1e-15 * lengths(force).sum()
    torque = np.cross(x, force)
    assert lengths(torque.sum(axis=0)[None])[0] < 1e-15 * (lengths(x) * lengths(force)).sum()


def test_forces_are_the_slope_of_the_energy():
    x, mass = cloud(40)
    gravity = gravity_of(x, mass, 1e4)
    pull = accelerations(gravity)
    for axis in range(3):
        step = np.zeros_like(x)
        step[7, axis] = 1.0
        after, before = (energy_at(gravity, x + sign * step, mass) for sign in (1.0, -1.0))
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
    solver = BarnesHut(particles_at(x, mass), h, opening) if opening else DirectSum(particles_at(x, mass), h)
    a = accelerations(solver)[count:]
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
    assert energy(gravity_of(x, np.full(count, M / count), h)) == pytest.approx(-0.6 * G_N * M**2 / R, rel=0.01)
