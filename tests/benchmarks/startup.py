"""Time from the command to the end of a tiny run: with no kernel compiled before, and with all of them."""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from engine.scene.scene import Gravity
from tests.benchmarks.child import ROOT
from tests.benchmarks.scene import collision

WARM_RUNS = 3


def measure() -> dict[str, dict[str, float]]:
    """Wall and CPU time [s] of `python -m engine run` with an empty and with a full kernel cache."""
    with tempfile.TemporaryDirectory() as directory:
        runs = [_run(Path(directory), n) for n in range(1 + WARM_RUNS)]
    return {"cold": runs[0], "warm": min(runs[1:], key=lambda run: run["wall"])}


def _run(directory: Path, number: int) -> dict[str, float]:
    job = directory / str(number)
    job.mkdir()
    scene = collision(100, Gravity())
    (job / "scene.json").write_text(scene.model_copy(update={"end_time": scene.start_time + 1.0}).canonical())
    command = [sys.executable, "-m", "engine", "run", str(job), "--threads", "1"]
    wall, cpu = time.perf_counter(), _children()
    environment = {**os.environ, "XDG_CACHE_HOME": str(directory / "cache")}
    subprocess.run(command, cwd=ROOT, check=True, env=environment, capture_output=True)
    return {"wall": time.perf_counter() - wall, "cpu": _children() - cpu}


def _children() -> float:
    """CPU time [s] of all child processes that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
