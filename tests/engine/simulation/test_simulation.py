"""The events between steps."""

from pathlib import Path

import numpy as np
import pytest

from engine.constants import BLOCK_EDGE
from engine.device import backend
from engine.job.checkpoint import load_checkpoint, save_checkpoint
from engine.job.directory import JobDirectory
from engine.simulation.simulation import Simulation
from tests.helpers.device import Array
from tests.helpers.scenes import body, scene, started

PAIRS = 11
"""Pairs of particles along each axis of a cube."""

SPACING = 2.0
"""Of the pairs at the start [cells]."""


def exploding() -> Simulation:
    """A cube of pairs of particles that grows tenfold: in the end each pair has a block to itself, and they are many.

    Nothing pulls them together: rubble without gravity.
    """
    count = 2 * PAIRS**3
    given = scene(body(particles=count), end_time=100.0)
    line = SPACING * given.dx * (np.arange(PAIRS) - 0.5 * (PAIRS - 1))
    pairs = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    x = np.repeat(pairs, 2, axis=0) + 0.05 * given.dx * np.random.default_rng(1).normal(size=(count, 3))
    return started(given, x=x, v=0.09 * np.repeat(pairs, 2, axis=0))


def blocks_taken(x: Array, dx: float) -> int:
    """Number of blocks, cubes of 4 x 4 x 4 cells, that contain particles."""
    return len(np.unique(np.floor(x / (BLOCK_EDGE * dx)), axis=0))


def finish(simulation: Simulation) -> dict[str, Array]:
    while not simulation.finished:
        simulation.advance(simulation.scene.end_time)
    return simulation.particles.read()


@pytest.mark.usefixtures("taichi")
def test_room_for_blocks_grows_without_a_trace_in_the_results(tmp_path: Path) -> None:
    """The same bits as from the same state in a simulation that has that room from the start."""
    simulation = exploding()
    dx, room = simulation.scene.dx, simulation.stencil.capacity
    save_checkpoint(JobDirectory(tmp_path), simulation, {})
    assert blocks_taken(simulation.particles.read("x")["x"], dx) < room
    grown = finish(simulation)
    assert room < blocks_taken(grown["x"], dx) <= simulation.stencil.capacity
    ample = simulation.stencil.capacity
    load_checkpoint(JobDirectory(tmp_path), simulation)
    again = finish(simulation)
    assert simulation.stencil.capacity == ample
    for name, values in grown.items():
        np.testing.assert_array_equal(again[name], values, err_msg=name)


def test_the_last_step_ends_at_the_end_time() -> None:
    backend.start(threads=1)
    simulation = started(scene(body(velocity=(1000.0, 0.0, 0.0)), end_time=10.0))
    while not simulation.finished:
        simulation.advance(simulation.scene.end_time)
    assert simulation.time == 10.0 and simulation.step > 3
    assert simulation.clock.dt[None] < simulation.next_dt, "the last step was cut short"
