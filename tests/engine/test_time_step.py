import numpy as np
import pytest

from tests.engine.moving import RUBBLE, body, one_step, scene, started
from tests.engine.oracle import LONGITUDINAL, RHO0

pytestmark = pytest.mark.usefixtures("taichi")

LONGITUDINAL_SPEED = float(np.sqrt(LONGITUDINAL / RHO0))


def test_the_time_step_obeys_the_tightest_of_its_limits():
    given = scene(body())
    simulation, dx = started(given), given.dx
    x, first = simulation.particles.read("x")["x"], 0.5 * dx / LONGITUDINAL_SPEED
    gradient = np.tile(0.3 * np.eye(3), (100, 1, 1))
    limits = [
        ({}, first),
        ({"v": np.tile([3000.0, 0.0, 4000.0], (100, 1))}, 0.5 * dx / (LONGITUDINAL_SPEED + 5000.0)),
        ({"v": x @ gradient[0], "C": gradient}, 0.3 / (0.3 * np.sqrt(3.0))),
    ]
    for state, expected in limits:
        simulation.start(**state)
        one_step(simulation)
        # the state after one step: compression and speed have hardly changed
        assert 1.0 / simulation.clock.rate[None] == pytest.approx(expected, rel=1e-2)


def test_strong_gravity_shortens_the_time_step():
    given = scene(body(), physics={**RUBBLE, "uniform_gravity": (0.0, -1e4, 0.0)})
    # at rest after one step
    first = 0.5 * given.dx / LONGITUDINAL_SPEED
    simulation = started(given, v=np.tile([0.0, 1e4 * first, 0.0], (100, 1)))
    one_step(simulation)
    assert 1.0 / simulation.clock.rate[None] == pytest.approx(np.sqrt(given.dx / 1e4), rel=1e-2)


def test_viscosity_and_the_courant_number_shorten_the_time_step():
    viscous = {"fracture": None, "gravity": None, "viscosity": {"shear": 1e9, "bulk": 2e9}}
    given = scene(body(), physics=viscous, numerics={"cfl": 0.2})
    simulation = started(given)
    assert one_step(simulation) == pytest.approx(0.2 * given.dx / LONGITUDINAL_SPEED, rel=1e-4)
    assert 1.0 / simulation.clock.rate[None] == pytest.approx(given.dx**2 / (6.0 * 3e9), rel=1e-4)
