"""Scenes run at the settings of their harness, which measures what their steps cost."""

import numpy as np
import pytest

from engine.verification.harness import Harness, State, altered, fitted_order
from engine.verification.problems.column import StandingWave


@pytest.mark.usefixtures("taichi")
def test_settings_replace_those_of_the_scene_and_of_no_other_harness():
    scene = StandingWave(8).scene
    fine = Harness({"numerics.cfl": 0.1}).start(scene)
    assert fine.scene == altered(scene, "numerics.cfl", 0.1) != scene
    assert Harness().start(scene).scene == scene


def test_a_setting_of_a_part_that_is_left_out_has_no_effect():
    scene = StandingWave(8).scene
    assert altered(scene, "physics.gravity.opening", 0.2) == scene
    assert altered(scene, "physics.sound_speed", 0.5).physics.sound_speed == 0.5


@pytest.mark.usefixtures("taichi")
def test_a_run_ends_at_the_first_step_that_reaches_its_end_and_its_cost_adds_up():
    harness = Harness()
    simulation = harness.start(StandingWave(8).scene)
    assert harness.cpu_time == 0.0
    costs = []
    for part in (0.25, 0.5, 2.0):
        end = part * simulation.scene.end_time
        state = harness.run_until(simulation, end)
        assert state.time == simulation.time >= min(end, simulation.scene.end_time)
        assert state.time - simulation.scene.end_time / simulation.step < end
        costs.append(harness.cpu_time)
    assert 0.0 < costs[0] < costs[1] < costs[2]


@pytest.mark.usefixtures("taichi")
def test_fields_of_the_initial_state_can_be_replaced():
    simulation = Harness().start(StandingWave(8).scene, v=np.full((256, 3), 2.0))
    np.testing.assert_array_equal(simulation.particles.read("v")["v"], 2.0)


def test_a_state_is_read_in_the_terms_of_the_equations():
    fields = {
        "v": np.array([[3.0, 0.0, 4.0]]),
        "j": np.array([-0.5]),
        "tau": np.array([[-3.0, -2.0, -1.0, 9.0, 9.0, 9.0]]),
        "damage_root": np.array([0.5]),
    }
    state = State(0.0, fields)
    assert (state.speed[0], state.J[0], state.P[0], state.damage[0]) == (5.0, 0.5, 4.0, 0.125)


def test_the_fitted_order_of_a_power_law_is_its_exponent():
    assert fitted_order([1.0, 2.0, 4.0], [3.0, 12.0, 48.0]) == pytest.approx(2.0)
