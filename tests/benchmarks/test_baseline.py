"""The engine is compared with a baseline that solves the same equations: both must give the same results."""

import pytest

from engine.device import backend
from engine.simulation.simulation import Simulation
from tests.benchmarks.baseline import (
    ROUND_OFF,
    ROUND_OFF_SVD,
    baseline,
    dense_grid_only,
    differences,
    step_together,
)
from tests.benchmarks.contact import in_contact
from tests.benchmarks.dense import DenseTransfer
from tests.benchmarks.scene import collision

STEPS = 20
CONTACT = 0.0
"""Time [s] after point-mass contact: all bodies are under stress, and not yet all broken."""


Ready = tuple[Simulation, DenseTransfer, DenseTransfer]


@pytest.fixture(scope="module")
def ready() -> Ready:
    """A collision in the engine and, from the same state on, with and without the usual decomposition."""
    backend.start(threads=1)
    simulation = in_contact(collision(500, transfer="apic", contact=None), CONTACT)
    return simulation, baseline(simulation), dense_grid_only(simulation)


def test_the_usual_way_gives_the_results_of_the_engine(ready):
    simulation, usual, dense = ready
    before = simulation.particles.read("damage_root", "b_minus_I")
    step_together(simulation, [usual, dense], STEPS)
    after = simulation.particles.read("damage_root", "b_minus_I")
    assert (before["damage_root"] != after["damage_root"]).sum() > 100 and (
        before["b_minus_I"] != after["b_minus_I"]
    ).all(axis=1).sum() > 500
    assert max(differences(simulation, usual).values()) < ROUND_OFF_SVD
    assert max(differences(simulation, dense).values()) < ROUND_OFF


def test_a_different_step_is_seen(ready):
    simulation, usual, dense = ready
    for other, limit in ((usual, ROUND_OFF_SVD), (dense, ROUND_OFF)):
        other.step(1e-4, 1e-4)
        assert differences(simulation, other)["x"] > limit
