"""The affine particle-in-cell transfer: one step against a dense grid, and its damping."""

import numpy as np
import pytest

from engine.scene.scene import Numerics
from engine.simulation.initial_conditions import initial_state
from tests.engine.mpm.test_filtered import CLOUD, lengths, random_state, shear_column, wave_kept
from tests.helpers.dense_grid import DenseGrid, Motion, affine_velocity, forces
from tests.helpers.device import worst
from tests.helpers.scenes import body, one_step, scene, started

pytestmark = pytest.mark.usefixtures("taichi")


@pytest.mark.parametrize("spread", [0.3, 8.0])
def test_one_step_equals_a_dense_grid(spread):
    given = scene(body(particles=CLOUD), physics={"fracture": None}, numerics=Numerics(transfer="apic"))
    state = random_state(spread, given.dx)
    simulation = started(given, **state)
    dt = one_step(simulation)
    grid = DenseGrid(state["x"], state["mass"], given.dx)
    kick = forces(state, given.dx, float(simulation.clock.kick[None]))
    q = grid.project(Motion(state["v"], state["C"]).plus(kick))
    alone = grid.alone[:, None]
    v = np.where(alone, state["v"] + kick.v, q.v)
    spin = 0.5 * (state["C"] - state["C"].transpose(0, 2, 1))
    C = np.where(alone[..., None], spin, affine_velocity(q.C, dt, state["j"], 1.0 / dt))
    found = simulation.particles.read("x", "v", "C")
    assert worst(found["v"], v, lengths(v) + 1.0) < 1e-12
    assert worst(found["x"], state["x"] + dt * v, given.dx) < 1e-12
    assert worst(found["C"], C, 1e-3) < 1e-10


@pytest.mark.parametrize(("cells", "per_cell"), [(8, 2), (8, 4), (32, 2)])
def test_every_step_damps_a_shear_wave_by_the_closed_form(cells, per_cell):
    given = shear_column(cells, per_cell, transfer="apic")
    wave = np.sin(2.0 * np.pi / cells * initial_state(given)["x"][:, 2])
    simulation = started(given, v=np.outer(wave, [1.0, 0.0, 0.0]))
    amplitudes = []
    for _ in range(4):
        one_step(simulation)
        amplitudes.append(float(np.mean(wave * simulation.particles.read("v")["v"][:, 0])))
    kept = np.array(amplitudes[1:]) / amplitudes[:-1]
    assert np.abs(kept - wave_kept(2.0 * np.pi / cells, per_cell)).max() < 1e-13
