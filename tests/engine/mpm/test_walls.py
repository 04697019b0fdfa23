"""Periodic axes and rigid walls."""

import numpy as np
import pytest
import taichi as ti

from engine.mpm.walls import Walls
from engine.scene.scene import Scene, Wall
from engine.simulation.initial_conditions import initial_state
from engine.verification.harness import Harness, State
from tests.helpers.device import Array
from tests.helpers.scenes import box_scene


def end_of(scene: Scene, **fields: Array) -> State:
    """The state after 20 ms."""
    harness = Harness()
    return harness.run_until(harness.start(scene, **fields), 0.02)


@pytest.mark.usefixtures("taichi")
def test_matter_flows_through_a_periodic_axis_unchanged():
    scene = box_scene(velocity=(1000.0, 0.0, 0.0))
    end = end_of(scene)
    moved = initial_state(scene)["x"][:, 0] + 20.0
    # round-off of some 200 steps
    assert np.abs((end.x[:, 0] - moved + 4.0) % 8.0 - 4.0).max() < 1e-10
    assert np.abs(end.J - 1.0).max() < 1e-12
    np.testing.assert_allclose(end.v, np.tile([1000.0, 0.0, 0.0], (128, 1)), atol=1e-9)


@pytest.mark.usefixtures("taichi")
def test_results_do_not_depend_on_where_the_period_begins():
    scene = box_scene()
    x = initial_state(scene)["x"]
    v = np.outer(np.sin(np.pi * x[:, 0] / 4.0), [1.0, 0.0, 0.0])
    here = end_of(scene, v=v)
    there = end_of(scene, v=v, x=x + np.array([4.0, 0.0, 0.0]))
    np.testing.assert_allclose(here.v, there.v, atol=1e-12)


@pytest.mark.usefixtures("taichi")
def test_a_wall_takes_away_what_moves_into_it():
    """Nothing flows through a smooth wall, and what slides along it is not slowed."""
    wall = {"point": [0.0, -0.5, 0.0], "normal": [0.0, 2.0, 0.0]}
    scene = box_scene(velocity=(3.0, -1.0, 0.0), walls=[wall])
    end = end_of(scene)
    assert end.x[:, 1].min() > -0.5
    np.testing.assert_allclose(end.v[:, 0], 3.0, atol=1e-9)


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize(
    ("friction", "expected"),
    [(0.0, (3.0, 0.0, 4.0)), (0.5, (2.7, 0.0, 3.6)), (6.0, (0.0, 0.0, 0.0)), ("stick", (0.0, 0.0, 0.0))],
)
def test_a_wall_slows_a_node_by_coulombs_impulse(friction, expected):
    walls = Walls([Wall(normal=(0.0, 1.0, 0.0), friction=friction)])
    after = ti.Vector.field(3, ti.f64, 3)

    @ti.kernel
    def apply():
        after[0] = walls.apply(ti.Vector([0.0, 0.0, 0.0]), ti.Vector([3.0, -1.0, 4.0]))
        after[1] = walls.apply(ti.Vector([0.0, 0.1, 0.0]), ti.Vector([3.0, -1.0, 4.0]))
        after[2] = walls.apply(ti.Vector([0.0, -1.0, 0.0]), ti.Vector([3.0, 1.0, 4.0]))

    apply()
    np.testing.assert_allclose(after[0], expected, atol=1e-14)
    # a node in front of the wall is free, and one behind it may leave unless the wall sticks
    np.testing.assert_array_equal(after[1], (3.0, -1.0, 4.0))
    np.testing.assert_array_equal(after[2], (0.0, 0.0, 0.0) if friction == "stick" else (3.0, 1.0, 4.0))
