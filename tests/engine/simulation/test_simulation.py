"""The events between steps."""

import numpy as np
import pytest

from engine.device import backend
from engine.scene.collision import Collision
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import Arrays


def scattering() -> Scene:
    """Two small bodies that shatter into fragments of a few particles each."""
    settings = {"velocity": 2000.0, "angle": 15.0, "particles": 100, "start_separation": 1.1, "end_time": 150.0}
    return Collision.model_validate(settings).scene()


def final_state(scene: Scene) -> tuple[Arrays, int]:
    """State at the end and the room for blocks that was needed."""
    backend.start(threads=1)
    simulation = Simulation(scene)
    simulation.start()
    while not simulation.finished:
        simulation.advance(scene.end_time)
    return simulation.particles.read(), simulation.stencil.capacity


def test_room_for_blocks_grows_without_a_trace_in_the_results(monkeypatch: pytest.MonkeyPatch) -> None:
    ample, _ = final_state(scattering())
    monkeypatch.setattr("engine.mpm.stencil.capacity", lambda count: 4 if count == 25 else count)
    grown, room = final_state(scattering())
    assert room > 4
    for name, values in ample.items():
        np.testing.assert_array_equal(grown[name], values, err_msg=name)


def test_the_last_step_ends_at_the_end_time() -> None:
    scene = scattering()
    backend.start(threads=1)
    simulation = Simulation(scene)
    simulation.start()
    while not simulation.finished:
        simulation.advance(scene.end_time)
    assert simulation.time == scene.end_time
