"""The same scene gives the same bits, however it is run."""

from typing import Any

import numpy as np
import pytest

import engine.simulation.simulation
from engine.device import backend
from engine.scene.collision import Collision
from engine.scene.scene import Scene
from engine.simulation.simulation import LAUNCHES, Simulation

WHOLE = Collision.model_validate(
    {"velocity": 1000.0, "angle": 15.0, "particles": 60, "start_separation": 1.1, "end_time": 400.0}
).scene()
"""All parts of physics, two bodies, particles that leave their blocks while steps are being launched."""


def run(scene: Scene, pauses: list[float], threads: int = 1) -> dict[str, Any]:
    """State at the end, after stops at all `pauses` [s]."""
    backend.start(threads=threads)
    simulation = Simulation(scene)
    simulation.start()
    for pause in [*pauses, scene.end_time]:
        while simulation.time < pause:
            simulation.advance(pause)
    clock = {"time": simulation.time, "step": simulation.step, "dt": simulation.clock.dt[None]}
    return {**simulation.particles.read(), **clock}


def assert_same(one: dict[str, Any], other: dict[str, Any]) -> None:
    for name, values in one.items():
        assert np.array_equal(values, other[name]), name


@pytest.fixture(scope="module")
def reference() -> dict[str, Any]:
    return run(WHOLE, [])


def test_the_reference_collides(reference):
    assert reference["step"] > 100
    assert reference["time"] == WHOLE.end_time
    assert reference["damage_root"].max() == 1.0
    # at half of the impact speed a body crosses more than two cells in the time of one launch
    step = (WHOLE.end_time - WHOLE.start_time) / reference["step"]
    assert 500.0 * LAUNCHES * step > 2.0 * WHOLE.dx


@pytest.mark.parametrize("launches", [1, 7, 1000])
def test_steps_per_launch_do_not_matter(monkeypatch, reference, launches):
    monkeypatch.setattr(engine.simulation.simulation, "LAUNCHES", launches)
    assert_same(run(WHOLE, []), reference)


@pytest.mark.parametrize("interval", [0.1, 3.0, 61.0])
def test_pauses_do_not_matter(reference, interval):
    pauses = list(np.arange(WHOLE.start_time, WHOLE.end_time, interval))
    assert_same(run(WHOLE, pauses), reference)


def test_two_threads_give_the_bits_of_one(reference):
    assert_same(run(WHOLE, [], threads=2), reference)


def test_running_again_gives_the_same_bits_and_another_seed_does_not(reference):
    assert_same(run(WHOLE, []), reference)
    other = run(WHOLE.model_copy(update={"seed": 2}), [])
    assert not np.array_equal(other["x"], reference["x"])
