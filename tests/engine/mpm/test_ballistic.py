"""Particles that share no node with another."""

import numpy as np
import pytest

from tests.helpers.scenes import RUBBLE, advance, body, scene, started

pytestmark = pytest.mark.usefixtures("taichi")


@pytest.mark.parametrize("gap", [3.5, 1000.0])
def test_a_lonely_particle_flies_straight_with_a_frozen_state(gap):
    """Also when its block has neighbours, as long as it shares no node. Its strain rate is that of one step's turn."""
    one = body(particles=1, position=(0.0, 0.0, 0.0), velocity=(150.0, 0.0, 80.0))
    dx = scene(one).dx
    crowd = body(particles=40, radius=50e3 * 40 ** (1 / 3), velocity=(150.0, 0.0, 80.0))
    centre = crowd["radius"] + gap * dx
    given = scene(one, {**crowd, "position": (0.0, centre, 0.0)})
    generator = np.random.default_rng(3)
    state = {
        "C": 1e-4 * generator.normal(size=(41, 3, 3)),
        "b_minus_I": 1e-3 * generator.normal(size=(41, 6)),
        "tau": 1e8 * generator.normal(size=(41, 6)),
        "j": 1e-3 * generator.random(41),
        "E": generator.random(41),
        "damage_root": np.full(41, 0.5),
    }
    state["C"][1:] = state["tau"][1:] = 0.0
    simulation = advance(started(given, **state), 40)
    found = simulation.particles.read("x", "v", "C", "b_minus_I", "tau", "j", "E", "damage_root")
    for name in ("b_minus_I", "tau", "j", "E", "damage_root"):
        assert np.array_equal(found[name][0], state[name][0])
    assert np.array_equal(found["v"][0], [150.0, 0.0, 80.0])
    np.testing.assert_allclose(found["x"][0], simulation.time * found["v"][0], rtol=1e-13)
    C, turn = found["C"][0], 0.5 * (state["C"][0] - state["C"][0].T)
    assert np.array_equal(0.5 * (C - C.T), turn)
    assert np.linalg.norm(0.5 * (C + C.T)) < 1.01 * simulation.clock.dt[None] * np.linalg.norm(turn @ turn)


def test_lonely_particles_on_a_collision_course_meet():
    """Bodies too small to fill a node touch where they share nodes."""
    one = body(particles=1)
    dx = scene(one).dx
    left = {**one, "position": (-5.0 * dx, 0.0, 0.0), "velocity": (200.0, 0.0, 0.0)}
    right = {**one, "position": (5.0 * dx, 0.0, 0.0), "velocity": (-200.0, 0.0, 0.0)}
    simulation = started(scene(left, right, end_time=20.0 * dx / 200.0))
    while not simulation.finished:
        simulation.advance(simulation.scene.end_time)
    found = simulation.particles.read("x", "v")
    assert found["x"][0, 0] < found["x"][1, 0], "neither has passed through the other"


@pytest.mark.parametrize("friction", [0.0, 0.1, "stick"])
def test_a_lonely_particle_falls_onto_a_wall_and_stays(friction):
    """All that gravity gives it goes into the wall, and friction takes its share of that."""
    one = body(particles=1, radius=100.0, position=(0.0, 0.0, 500.0), velocity=(20.0, 0.0, 0.0))
    wall = {"normal": (0.0, 0.0, 2.0), "friction": friction}
    physics = {**RUBBLE, "uniform_gravity": (0.0, 0.0, -9.81), "walls": [wall]}
    simulation = started(scene(one, physics=physics, end_time=12.0))
    lowest = 500.0
    while not simulation.finished:
        simulation.advance(simulation.scene.end_time, steps=1)
        lowest = min(lowest, float(simulation.particles.read("x")["x"][0, 2]))
    found = simulation.particles.read("x", "v")
    assert lowest >= 0.0 and found["x"][0, 2] < 5.0, "as near as a step of the fall"
    kicked = 9.81 * (12.0 - 0.5 * float(simulation.clock.dt[None]))  # velocities belong to the middle of the step
    stopped = kicked + found["v"][0, 2]
    along = 0.0 if friction == "stick" else 20.0 - friction * stopped
    np.testing.assert_allclose(found["v"][0, :2], [along, 0.0], atol=1e-12)
    assert stopped == pytest.approx(kicked, rel=2e-3)
