"""Logarithmic strain from singular values and the engine's way: `python -m tests.benchmarks.log_strain`."""

from collections.abc import Iterator

import numpy as np
import taichi as ti
from rich.console import Console
from rich.table import Table

from engine.device import backend
from engine.device.backend import mat3, vec3, vec6
from engine.device.fields import overwrite
from engine.device.tensors import deviator, half_log, unpack
from engine.state.particles import Arrays
from tests.benchmarks.stopwatch import Stopwatch
from tests.benchmarks.stretch import deformation_gradient

COUNT = 40_000
SIZES = (1e-6, 1e-4, 1e-2, 0.1)
"""Norm of the strain; beyond 0.025 the engine's series gives way to eigenvectors."""
ROUNDS = 12
TITLES = ("strain", "ti.svd [ms]", "engine [ms]", "ratio", "error of ti.svd", "of the engine")


@ti.data_oriented
class LogStrain:
    """Deviatoric logarithmic strain of the same particles, from F and from F F^T - I.

    Args:
        state: B and j of every particle.
    """

    def __init__(self, state: Arrays) -> None:
        self.F, self.B = mat3.field(shape=COUNT), vec6.field(shape=COUNT)
        self.result = mat3.field(shape=COUNT)
        overwrite(self.F, deformation_gradient(state))
        overwrite(self.B, state["b_minus_I"])

    @ti.kernel
    def by_svd(self):
        """U dev(ln Sigma) U^T."""
        for p in range(COUNT):
            U, S, _ = ti.svd(self.F[p])
            logs = vec3(ti.log(S[0, 0]), ti.log(S[1, 1]), ti.log(S[2, 2]))
            logs -= logs.sum() / 3.0
            self.result[p] = U @ mat3(logs[0], 0, 0, 0, logs[1], 0, 0, 0, logs[2]) @ U.transpose()

    @ti.kernel
    def by_series(self):
        """The engine's way."""
        for p in range(COUNT):
            self.result[p] = deviator(half_log(unpack(self.B[p])))


def compare(size: float) -> tuple[list[float], list[float]]:
    """Median CPU time [ms] of both ways, which take turns, and their largest errors in units of the strain."""
    strain, state = strains(size)
    law = LogStrain(state)
    kernels, watches = (law.by_svd, law.by_series), (Stopwatch(), Stopwatch())
    errors = []
    for kernel in kernels:
        kernel()
        errors.append(float(np.abs(law.result.to_numpy() - strain).max()) / size)
    for _ in range(ROUNDS):
        for watch, kernel in zip(watches, kernels, strict=True):
            with watch.lap():
                kernel()
    return [watch.summary()["cpu_ms"] for watch in watches], errors


def strains(size: float) -> tuple[np.ndarray, Arrays]:
    """Random deviatoric strains of one norm, and the state of particles that have them."""
    generator = np.random.default_rng(1)
    logs = generator.normal(size=(COUNT, 3))
    logs -= logs.mean(axis=1, keepdims=True)
    logs *= size / np.linalg.norm(logs, axis=1, keepdims=True)
    axes, _ = np.linalg.qr(generator.normal(size=(COUNT, 3, 3)))
    strain, B = (np.einsum("nik,nk,njk->nij", axes, values, axes) for values in (logs, np.expm1(2.0 * logs)))
    return strain, {"b_minus_I": B[:, [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]], "j": np.zeros(COUNT)}


def rows() -> Iterator[tuple[str, ...]]:
    """Rows of the table."""
    for size in SIZES:
        backend.start(threads=1)
        (svd, series), errors = compare(size)
        yield f"{size:g}", f"{svd:.2f}", f"{series:.2f}", f"{svd / series:.1f}", *(f"{error:.0e}" for error in errors)


if __name__ == "__main__":
    table = Table(*TITLES, title=f"{COUNT:,} particles, one thread, CPU time")
    for row in rows():
        table.add_row(*row)
    Console(width=110).print(table)
