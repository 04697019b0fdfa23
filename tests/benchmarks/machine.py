"""What the machine can do at most: copying memory, and multiplying and adding in registers."""

from typing import Any

import taichi as ti

from engine.device import backend
from engine.device.backend import TASK, Real
from tests.benchmarks.child import answer
from tests.benchmarks.stopwatch import Stopwatch

LENGTH = 1 << 24
"""Numbers in each copied array: 128 MiB, more than any cache."""
ROWS, COLUMNS, REPEATS = 16, 8, 2_000_000
"""Numbers that one thread multiplies and adds to in turn, in rows and columns, and how often."""
LAPS = 10


@ti.data_oriented
class Machine:
    """Kernels that do one thing as fast as compiled code like the engine's can."""

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self.source, self.target = ti.field(Real, LENGTH), ti.field(Real, LENGTH)
        self.sums = ti.field(Real, threads)

    def copy(self) -> None:
        """Copy an array."""
        self.copy_entries(LENGTH)

    @ti.kernel
    def copy_entries(self, count: ti.i32):
        """Copy entries; a range that is not known when this is compiled may be longer than Vulkan launches at once."""
        for i in range(count):
            self.target[i] = self.source[i]

    @ti.kernel
    def multiply_add(self):
        """x <- a x + b on as many numbers as the registers hold, in every thread."""
        for t in range(self.threads * TASK):
            if t % TASK == 0:
                a, b = self.source[t], self.target[t]
                x = ti.Vector([ti.cast(t + i, Real) for i in range(ROWS * COLUMNS)])
                for _ in range(REPEATS):
                    x = a * x + b
                for row in ti.static(range(ROWS)):
                    for column in ti.static(range(COLUMNS)):
                        self.sums[t // TASK] += x[row * COLUMNS + column]


def copying(arch: str) -> dict[str, Any]:
    """Best of some runs on a device: copied bytes per second, read and written."""
    backend.start(arch)
    return {"bytes_per_second": 2.0 * 8.0 * LENGTH / _least(Machine(1).copy)}


def measure(threads: int, arch: str = "cpu") -> dict[str, Any]:
    """Best of some runs: copied bytes per second, read and written, and, on a CPU, operations per second."""
    if arch != "cpu":
        return copying(arch)
    backend.start(threads=threads)
    machine = Machine(threads)
    operations = 2.0 * ROWS * COLUMNS * REPEATS * threads
    return {
        "threads": threads,
        "bytes_per_second": 2.0 * 8.0 * LENGTH / _least(machine.copy),
        "operations_per_second": operations / _least(machine.multiply_add),
    }


def _least(kernel: Any) -> float:
    """Shortest time of a kernel [s], compiled before."""
    watch = Stopwatch()
    kernel()
    for _ in range(LAPS):
        with watch.lap():
            kernel()
    return min(watch.wall)


if __name__ == "__main__":
    answer(measure)
