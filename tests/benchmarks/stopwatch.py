"""Wall and CPU time of repeated work: the machine is shared, so every figure has both."""

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from engine.device import backend


class Stopwatch:
    """Times of laps [s]; CPU time is that of all threads of this process."""

    def __init__(self) -> None:
        self.wall: list[float] = []
        self.cpu: list[float] = []

    @contextmanager
    def lap(self) -> Iterator[None]:
        """Time the work in the `with` block."""
        wall, cpu = time.perf_counter(), time.process_time()
        yield
        backend.wait()
        self.wall.append(time.perf_counter() - wall)
        self.cpu.append(time.process_time() - cpu)

    def summary(self) -> dict[str, float]:
        """Median and least wall time and median CPU time [ms]; nothing when there were no laps."""
        if not self.wall:
            return {}
        return {
            "median_ms": 1e3 * float(np.median(self.wall)),
            "least_ms": 1e3 * min(self.wall),
            "cpu_ms": 1e3 * float(np.median(self.cpu)),
        }


def total(watches: Sequence[Stopwatch]) -> Stopwatch:
    """Lap by lap the sum of several watches."""
    result = Stopwatch()
    result.wall = [sum(laps) for laps in zip(*(watch.wall for watch in watches), strict=True)]
    result.cpu = [sum(laps) for laps in zip(*(watch.cpu for watch in watches), strict=True)]
    return result
