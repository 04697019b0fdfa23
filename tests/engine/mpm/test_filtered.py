"""The filtered transfer: one step against a dense grid, its damping, and the energy it turns into heat."""

import numpy as np
import pytest

from engine.device import backend
from engine.mpm.filtered import Filtered
from engine.scene.bodies import Box
from engine.scene.scene import Numerics, Physics, Scene
from engine.simulation.initial_conditions import initial_state
from engine.simulation.simulation import Simulation
from tests.helpers.dense_grid import DenseGrid, Motion, affine_velocity, forces
from tests.helpers.device import Array, worst
from tests.helpers.scenes import body, one_step, scene, spline, started

CLOUD = 150
"""Particles that are compared with a dense grid."""


def lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt((vectors**2).sum(axis=1)))


def random_state(spread: float, dx: float) -> dict[str, Array]:
    """A cloud with any velocity, stress and gravity."""
    generator = np.random.default_rng(1)
    return {
        "x": spread * dx * generator.normal(size=(CLOUD, 3)),
        "v": 100.0 * generator.normal(size=(CLOUD, 3)),
        "C": 1e-3 * generator.normal(size=(CLOUD, 3, 3)),
        "tau": 1e8 * generator.normal(size=(CLOUD, 6)),
        "acceleration": generator.normal(size=(CLOUD, 3)),
        "mass": 1e17 * generator.uniform(0.5, 2.0, CLOUD),
        "j": generator.uniform(-0.5, 1.0, CLOUD),
    }


def drift(x: Array, q: Motion, dt: float, j: Array, steepest: float) -> tuple[Array, Motion]:
    return x + dt * q.v, Motion(q.v, affine_velocity(q.C, dt, j, steepest))


def dense_step(
    state: dict[str, Array], J: Array, dx: float, dt: float, kick_time: float, scheme: Filtered
) -> tuple[Array, Motion, Array]:
    """One step of the filtered transfer (section 1): positions, motion, and which particles share no node at first.

    The volume J after the step is the engine's own: it only bounds the affine velocity.
    """
    q, j, steepest = Motion(state["v"], state["C"]), state["j"], scheme.steepest[None]
    grid = DenseGrid(state["x"], state["mass"], dx)
    kick = forces(state, dx, kick_time)
    kicked, free = q.plus(grid.project(kick)), Motion(q.v + kick.v, 0.5 * (q.C - q.C.transpose(0, 2, 1)))
    alone = grid.alone[:, None]
    q = Motion(np.where(alone, free.v, kicked.v), np.where(alone[..., None], free.C, kicked.C))
    x, q = drift(state["x"], q, 0.5 * dt, j, steepest)
    grid = DenseGrid(x, state["mass"], dx)
    remainder = q.plus(grid.project(q), -1.0)
    q = q.plus(remainder.plus(grid.project(remainder), -1.0), -min(1.0, dt * scheme.rate[None]))
    x, q = drift(x, q, 0.5 * dt, J - 1.0, steepest)
    return x, q, grid.alone


@pytest.fixture(scope="module")
def cloud() -> Simulation:
    """Particles with gravity, to be started in any state; the tests that use it stand together."""
    backend.start(threads=1)
    return Simulation(scene(body(particles=CLOUD), physics={"fracture": None}))


@pytest.mark.parametrize("spread", [0.3, 4.0, 8.0])
def test_one_step_equals_a_dense_grid(cloud, spread):
    """Dense, loose and mostly ballistic clouds."""
    dx = cloud.scene.dx
    state = random_state(spread, dx)
    cloud.start(**state)
    dt = one_step(cloud)
    found = cloud.particles.read("x", "v", "C", "j")
    x, q, alone = dense_step(state, 1.0 + found["j"], dx, dt, float(cloud.clock.kick[None]), cloud.scheme)
    assert alone.sum() == 0 if spread == 0.3 else alone.sum() > 2
    # the lightest node carries 1e-3 or less of a particle, and round-off of the sums as often
    assert worst(found["v"], q.v, lengths(q.v) + 1.0) < 1e-12
    assert worst(found["x"], x, dx) < 1e-12
    assert worst(found["C"], q.C, 1e-3) < 1e-10


def wave_kept(kdx: float, per_cell: int) -> float:
    """Share g of a shear wave's velocity that one projection leaves (engine/physics.md, section 1)."""
    u = (np.arange(3 * per_cell) + 0.5) / per_cell - 1.5
    terms = [spline(u) * spline(u + j) * (1.0 + 4.0 * u * (u + j)) * np.cos(kdx * j) for j in range(-2, 3)]
    return float(np.sum(terms) / per_cell)


def shear_column(cells: int, per_cell: int, **numerics: object) -> Scene:
    """A periodic column of a fluid, 4 x 4 cells of 1 m wide."""
    box = Box(size=(4.0, 4.0, cells), lattice=(4, 4, cells * per_cell), position=(2.0, 2.0, 0.5 * cells))
    physics = Physics(shear=False, strength=False, fracture=None, gravity=None)
    given = Numerics.model_validate({"particles_per_cell": per_cell, **numerics})
    return Scene(bodies=(box,), period=(4.0, 4.0, cells), end_time=1.0, physics=physics, numerics=given)


def damping_rate(given: Scene, cells: int, time: float) -> tuple[float, float]:
    """Rate [1/s] at which a shear wave across a column decays, and the time step [s].

    It is the motion that gives no momentum away: amplitudes of the projection, v weighted by the wave.
    """
    k = 2.0 * np.pi / cells
    z = initial_state(given)["x"][:, 2]
    C = np.zeros((len(z), 3, 3))
    C[:, 0, 2] = k * np.cos(k * z)
    simulation = started(given, v=np.outer(np.sin(k * z), [1.0, 0.0, 0.0]), C=C)
    amplitudes, times = [], []
    for until in (0.5 * time, time):
        while simulation.time < until:
            simulation.advance(until)
        q = simulation.particles.read("v", "C")
        part = np.sin(k * z) * q["v"][:, 0] + 0.25 * k * np.cos(k * z) * q["C"][:, 0, 2]
        amplitudes.append(float(part.mean()))
        times.append(simulation.time)
    return -np.log(amplitudes[1] / amplitudes[0]) / (times[1] - times[0]), float(simulation.clock.dt[None])


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("cells", [4, 8])
def test_a_shear_wave_decays_at_the_rate_of_the_filter_whatever_the_time_step(cells):
    """(1 - g)^2 over filter_time dx/c_l, of bodies at rest: g is that of one projection."""
    rates = []
    for cfl in (0.2, 0.8):
        given = shear_column(cells, 2, cfl=cfl, filter_time=2.0)
        time = 400.0 * given.dx / given.materials[0].longitudinal_speed
        rate, _ = damping_rate(given, cells, time)
        rates.append(rate * 2.0 * given.dx / given.materials[0].longitudinal_speed)
    expected = (1.0 - wave_kept(2.0 * np.pi / cells, 2)) ** 2
    assert rates == pytest.approx([expected, expected], rel=0.05)


def test_long_waves_lose_a_share_of_their_fourth_power_in_a_projection():
    """1 - (k dx)^4 / 42, where particles are dense."""
    loss = [(1.0 - wave_kept(kdx, 1000)) / kdx**4 for kdx in (0.1, 0.05)]
    # what is left of the limit is of order (k dx)^2
    assert loss[1] + (loss[1] - loss[0]) / 3.0 == pytest.approx(1.0 / 42.0, rel=1e-5)


@pytest.mark.usefixtures("taichi")
def test_the_heat_of_the_filter_is_the_kinetic_energy_it_takes():
    """A cloud without stress or gravity: what a step takes from the motion, affine part included, is in E."""
    given = scene(body(particles=CLOUD), physics={"fracture": None, "gravity": None, "strength": False, "shear": False})
    state = {**random_state(0.6, given.dx), "tau": np.zeros((CLOUD, 6)), "j": np.full(CLOUD, 3.0)}
    del state["acceleration"]
    simulation = started(given, **state)
    before = Motion(state["v"], state["C"]).square(given.dx)
    one_step(simulation)
    found = simulation.particles.read("v", "C", "E", "transfer_heat", "mass")
    after = Motion(found["v"], found["C"]).square(given.dx)
    lost = 0.5 * float(np.sum(found["mass"] * (before - after))) - simulation.totals().lost_energy
    assert lost > 0.1 * 0.5 * float(np.sum(found["mass"] * before)), "much of a random motion is filtered"
    assert float(np.sum(found["mass"] * found["transfer_heat"])) == pytest.approx(lost, rel=1e-12)
    assert np.array_equal(found["E"], found["transfer_heat"])
