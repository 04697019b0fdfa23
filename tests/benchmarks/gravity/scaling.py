"""Time of one evaluation of gravity against the number of particles, with the default opening."""

from typing import Any

from engine.device import backend
from engine.gravity.barnes_hut import BarnesHut
from engine.scene.scene import Gravity
from tests.benchmarks.child import answer
from tests.benchmarks.gravity.states import along_curve, sphere
from tests.benchmarks.stopwatch import Stopwatch

LAPS = 3


def measure(count: int) -> dict[str, Any]:
    """Least CPU time [ms] of the arrangement, of tree and walk, and of all that a simulation calls."""
    backend.start(threads=1)
    state = along_curve(sphere(count))
    particles = state.particles()
    tree = BarnesHut(particles, state.radius, Gravity().opening)
    tree.accelerate(0.0)
    watches = {"arrange": Stopwatch(), "solve": Stopwatch(), "accelerate": Stopwatch()}
    for _ in range(LAPS):
        with watches["arrange"].lap():
            tree.arrange()
        with watches["solve"].lap():
            tree.solve(potential=False)
            backend.ti.sync()
        with watches["accelerate"].lap():
            tree.accelerate(0.0)
    cpu = {name: 1e3 * min(watch.cpu) for name, watch in watches.items()}
    return {"count": count, **cpu}


if __name__ == "__main__":
    answer(measure)
