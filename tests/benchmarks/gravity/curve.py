"""Error against time of one code on one state, as its opening angle varies."""

from pathlib import Path
from typing import Any

import numpy as np

from tests.benchmarks.child import answer
from tests.benchmarks.gravity.codes import CODES
from tests.benchmarks.gravity.states import load
from tests.benchmarks.stopwatch import Stopwatch

OPENINGS = (0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
LAPS = 5


def measure(code: str, state: str, threads: int, quadrupole: bool) -> dict[str, Any]:
    """Least CPU and wall time [ms] of an evaluation, and relative errors of accelerations, for every opening."""
    solver = CODES[code](load(Path(state)), threads, quadrupole)
    exact = solver.exact()
    size = np.linalg.norm(exact, axis=1)
    rows = []
    for opening in OPENINGS:
        error = np.linalg.norm(solver.evaluate(opening) - exact, axis=1) / size
        watch = Stopwatch()
        for _ in range(LAPS):
            with watch.lap():
                solver.evaluate(opening)
        rows.append(
            {
                "opening": opening,
                "cpu_ms": 1e3 * min(watch.cpu),
                "wall_ms": 1e3 * min(watch.wall),
                "median": float(np.median(error)),
                "percentile_99": float(np.percentile(error, 99)),
            }
        )
    return {"code": code, "threads": threads, "quadrupole": quadrupole, "rows": rows}


if __name__ == "__main__":
    answer(measure)
