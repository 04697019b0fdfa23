"""One side of a comparison of two versions: steps of one scene, some at a time, when asked on standard input.

Run with another version's checkout on PYTHONPATH, so it uses what all versions have.
"""

import json
import sys
import time

BEGUN = time.perf_counter()

from engine.device import backend  # noqa: E402
from engine.scene.collision import Collision  # noqa: E402
from engine.simulation.simulation import Simulation  # noqa: E402


def main(particles: int, threads: int, seconds: float, steps: int) -> None:
    """Tell how long the start took [s], then the CPU time of a step [s] for every line that is read.

    Args:
        particles: of each body.
        threads: of the engine.
        seconds: simulated time after contact from which steps are timed.
        steps: of one lap.
    """
    backend.start(threads=threads)
    scene = Collision(velocity=200.0, angle=15.0, particles=particles, start_separation=1.05, end_time=1e5).scene()
    simulation = Simulation(scene)
    simulation.start()
    simulation.advance(scene.end_time, steps=1)
    tell(start=time.perf_counter() - BEGUN)
    while simulation.time < seconds:
        simulation.advance(seconds)
    for _ in sys.stdin:
        cpu, first = time.process_time(), simulation.step
        simulation.advance(scene.end_time, steps=steps)
        backend.wait()
        tell(cpu=(time.process_time() - cpu) / (simulation.step - first))


def tell(**figures: float) -> None:
    """Print figures as a line of JSON."""
    print(json.dumps(figures), flush=True)


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
