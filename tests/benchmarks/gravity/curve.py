"""Error against time of all codes on one state, as their opening angles vary.

All codes are in one process and take turns, so that other load on the machine disturbs all alike.
"""

from pathlib import Path
from typing import Any

import numpy as np

from engine.device import backend
from tests.benchmarks.child import answer
from tests.benchmarks.gravity.codes import CODES, Pull
from tests.benchmarks.gravity.states import along_curve, load
from tests.benchmarks.stopwatch import Stopwatch

LINES = (
    ("this project", True),
    ("this project", False),
    ("pytreegrav", True),
    ("pytreegrav", False),
    ("rebound", False),
)
"""Code, and whether its nodes have quadrupoles."""
OPENINGS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0)
LAPS = 5


def measure(state: str) -> dict[str, Any]:
    """Least CPU and wall time [ms] of an evaluation, and relative errors of all accelerations, for every opening."""
    backend.start(threads=1)
    given = along_curve(load(Path(state)))
    solvers = {line: CODES[line[0]](given, quadrupole=line[1]) for line in LINES}
    exact = {code: solver.exact() for (code, quadrupole), solver in solvers.items() if not quadrupole}
    errors = {
        (line, opening): error(solver.evaluate(opening), exact[line[0]])
        for line, solver in solvers.items()
        for opening in OPENINGS
    }
    watches = {run: Stopwatch() for run in errors}
    for _ in range(LAPS):
        for opening in OPENINGS:
            for line, solver in solvers.items():
                with watches[line, opening].lap():
                    solver.evaluate(opening)
    lines = [
        {
            "code": line[0],
            "quadrupole": line[1],
            "rows": [{"opening": o, **least(watches[line, o]), **errors[line, o]} for o in OPENINGS],
        }
        for line in LINES
    ]
    return {"lines": lines}


def error(pull: Pull, exact: Pull) -> dict[str, float]:
    """Median and 99th percentile of |da| / |a|."""
    relative = np.linalg.norm(pull - exact, axis=1) / np.linalg.norm(exact, axis=1)
    return {"median": float(np.median(relative)), "percentile_99": float(np.percentile(relative, 99))}


def least(watch: Stopwatch) -> dict[str, float]:
    """Least CPU and wall time [ms] of all laps."""
    return {"cpu_ms": 1e3 * min(watch.cpu), "wall_ms": 1e3 * min(watch.wall)}


if __name__ == "__main__":
    answer(measure)
