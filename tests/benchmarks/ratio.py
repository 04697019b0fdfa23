"""Time of the usual way, and of the default transfer, over that of the engine's APIC transfer.

All take turns within one process, so that other load disturbs them alike.
"""

from typing import Any

import numpy as np

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
from tests.benchmarks.child import answer
from tests.benchmarks.contact import continued, in_contact, take_step
from tests.benchmarks.dense import DenseTransfer
from tests.benchmarks.scene import collision
from tests.benchmarks.stopwatch import Stopwatch

AGREEMENT_STEPS = 20
BATCH = 5
"""Steps that one of them takes in its turn."""

TOLERANCE = {"baseline": ROUND_OFF_SVD, "dense_grid_only": ROUND_OFF}


def measure(particles: int, threads: int, contact: float, rounds: int) -> dict[str, Any]:
    """Agreement after some steps, then times and their ratios over `rounds` turns."""
    backend.start(threads=threads)
    simulation = in_contact(collision(particles, transfer="apic", contact=None), contact)
    others = {"baseline": baseline(simulation), "dense_grid_only": dense_grid_only(simulation)}
    step_together(simulation, list(others.values()), AGREEMENT_STEPS)
    found = {name: differences(simulation, other) for name, other in others.items()}
    for name, difference in found.items():
        assert max(difference.values()) < TOLERANCE[name], f"{name} differs from the engine: {difference}"
    default = continued(simulation, collision(particles, contact=None))
    watches = take_turns(simulation, default, others, rounds)
    engine = watches.pop("engine")
    return {
        "engine": per_step(engine),
        **{name: {**per_step(watch), **ratios(watch, engine)} for name, watch in watches.items()},
        "differences": found,
        "nodes": int(np.prod(others["baseline"].nodes.shape)),
    }


def take_turns(
    simulation: Simulation, default: Simulation, others: dict[str, DenseTransfer], rounds: int
) -> dict[str, Stopwatch]:
    """Times of batches of steps, one after the other; the others take those of the simulation."""
    watches = {name: Stopwatch() for name in ("engine", "default", *others)}
    take_step(default)
    for _ in range(rounds):
        with watches["default"].lap():
            for _ in range(BATCH):
                take_step(default)
        with watches["engine"].lap():
            steps = [take_step(simulation) for _ in range(BATCH)]
        for name, other in others.items():
            with watches[name].lap():
                for dt in steps:
                    other.step(dt, dt)
    return watches


def per_step(watch: Stopwatch) -> dict[str, float]:
    """Times of one step [ms]."""
    return {name: value / BATCH for name, value in watch.summary().items()}


def ratios(watch: Stopwatch, engine: Stopwatch) -> dict[str, float]:
    """How many times longer than the engine's turn: median over the rounds, and of the least times."""
    wall, cpu = (np.array(getattr(watch, kind)) / getattr(engine, kind) for kind in ("wall", "cpu"))
    return {
        "ratio": float(np.median(wall)),
        "ratio_of_least": min(watch.wall) / min(engine.wall),
        "ratio_of_cpu": float(np.median(cpu)),
    }


if __name__ == "__main__":
    answer(measure)
