"""Tests in single precision, which tests/engine/device/test_precision.py runs in a process of their own."""

import numpy as np
import pytest
import taichi as ti

from engine.constants import G_NEWTON
from engine.device.backend import PRECISION, mat3
from engine.errors import GuardFault
from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.job.snapshot import FIELDS, snapshot
from engine.mpm.affine import affine_velocity
from engine.scene.placement import sphere_points
from engine.simulation.conservation import as_row
from engine.simulation.guard import Guard
from engine.simulation.simulation import Simulation
from engine.state.particles import Particles
from tests.helpers.device import Array, finds
from tests.helpers.gravity import accelerations, energy
from tests.helpers.scenes import RUBBLE, advance, body, rubble_collision, scene, started

pytestmark = pytest.mark.usefixtures("taichi")


def test_this_process_is_in_single_precision() -> None:
    assert PRECISION == "f32"


SINGLE = {"numerics": {"precision": "f32"}}


@pytest.mark.parametrize(("place", "speed"), [(2e5, 0.02), (3e6, 1.0)])
@pytest.mark.parametrize("count", [1, 100])
def test_matter_moves_as_fast_as_its_velocity_says(place, speed, count):
    """A step is near one unit in the last place of a single-precision position."""
    radius = 1e3 * count ** (1.0 / 3.0)
    velocity = speed * np.array([0.48, -0.6, 0.64])
    one = body(particles=count, radius=radius, position=(place, -place, 0.5 * place), velocity=tuple(velocity))
    simulation = started(scene(one, **SINGLE))
    before = simulation.particles.read("x")["x"].mean(axis=0)
    advance(simulation, 200)
    moved = simulation.particles.read("x")["x"].mean(axis=0) - before
    np.testing.assert_allclose(moved, velocity * simulation.time, rtol=1e-6)


def pulls(x: Array, mass: Array, radius: float) -> Array:
    """Sum over all pairs of balls, in double precision."""
    gap = x[None] - x[:, None]
    square = np.maximum((gap**2).sum(axis=2), radius**2)
    return np.asarray(G_NEWTON * (mass[None, :, None] * gap / square[:, :, None] ** 1.5).sum(axis=1))


@pytest.mark.parametrize("R", [1e-3, 5e4, 6.4e6, 1e12])
@pytest.mark.parametrize("opening", [0.0, 0.4])
def test_gravity_of_bodies_of_any_size(R, opening):
    count, distance = 1000, 40.0 * R
    h = R * (4.0 / 3.0 * np.pi / count) ** (1.0 / 3.0)
    sphere = sphere_points(count, R, np.random.default_rng(1))
    x = np.concatenate([sphere, sphere + np.array([distance, 0.0, 0.0])])
    mass = np.full(2 * count, 2700.0 * h**3)
    particles = Particles(2 * count)
    particles.write({"x": x, "mass": mass, "v": np.zeros_like(x)})
    solver = BarnesHut(particles, h, opening) if opening else DirectSum(particles, h)
    exact = pulls(x, mass, h)
    error = np.linalg.norm(accelerations(solver) - exact, axis=1) / np.linalg.norm(exact, axis=1)
    assert np.percentile(error, 99) < (5e-3 if opening else 1e-4)
    assert energy(solver) == pytest.approx(-1.2 * G_NEWTON * (count * mass[0]) ** 2 / R, rel=0.1)


def test_the_ledger_sums_in_double_precision():
    simulation = advance(started(rubble_collision(**SINGLE)), 80)
    state = simulation.particles.read()
    assert {values.dtype.name for values in state.values()} == {"float64", "int32"}
    work = -float(np.sum(state["mass"] * state["half_step_work"]))
    assert work != 0.0 and simulation.totals().half_step_work == pytest.approx(work, rel=1e-12)


def test_energy_in_uniform_gravity_is_summed_in_double_precision():
    physics = {**RUBBLE, "uniform_gravity": (3.0, 0.0, -9.81)}
    simulation = started(scene(body(position=(1e6, 2e6, 3e6)), physics=physics, **SINGLE))
    state = simulation.particles.read("x", "mass")
    expected = -np.sum(state["mass"][:, None].astype(np.float64) * state["x"] * np.float32([3.0, 0.0, -9.81]))
    assert simulation.totals().gravitational_energy == pytest.approx(float(expected), rel=1e-13)


def test_a_snapshot_keeps_the_digits_of_small_strains():
    simulation = started(scene(body(), **SINGLE), j=np.linspace(-1e-6, 1e-6, 100))
    state = simulation.particles.read(*FIELDS)
    J = snapshot(state, simulation.rho0(state), {})["J"].values
    np.testing.assert_allclose(J - 1.0, np.linspace(-1e-6, 1e-6, 100), rtol=1e-7, atol=2e-16)


@pytest.mark.parametrize("size", [1e-12, 1e-6, 1.0, 1e6, 1e12])
def test_no_step_raises_the_energy_of_strain_rates(size):
    """A sheet of debris that closes at any rate: |sym C| J^(1/3) stays, where C (I + dt C)^-1 would raise it."""
    result = ti.Matrix.field(3, 3, ti.f32, ())

    @ti.kernel
    def affine(rate: ti.f32, dt: ti.f32):
        C = mat3(0.0)
        C[2, 2] = rate
        result[None] = affine_velocity(C, dt, 9.0, 1e18)

    affine(-size, 0.2 / size)
    np.testing.assert_allclose(result.to_numpy(), np.diag([0.0, 0.0, -size * 0.8 ** (-1.0 / 3.0)]), rtol=1e-6)


def test_a_number_that_is_not_finite_is_found():
    simulation = started(rubble_collision(**SINGLE))
    for name in ("x", "b_minus_I", "j"):
        assert finds(simulation, name, (np.nan, np.inf, -np.inf)) == [True, True, True], name


def test_a_push_stops_a_run():
    """A thousandth of the scene's speeds, which round-off is far from."""
    simulation = started(rubble_collision(**SINGLE))
    row = as_row(simulation.totals(), time=0.0)
    guard = Guard(simulation.scene, row, simulation.first_dt)
    check(guard, advance(simulation, 64))
    state = simulation.particles.read("v")
    push = 1e-3 * guard.momentum / float(row["mass"])
    simulation.particles.write({"v": state["v"] + [0.0, push, 0.0]})
    with pytest.raises(GuardFault, match="change of total momentum"):
        check(guard, simulation)


def check(guard: Guard, simulation: Simulation) -> None:
    row = as_row(simulation.totals(), time=simulation.time)
    guard.check(row, simulation.ledger.extremes(), simulation.particles)
