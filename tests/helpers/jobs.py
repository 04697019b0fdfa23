"""Small job directories and the engine's command line, for tests."""

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from engine.job.directory import JobDirectory
from engine.job.storage import read_dataset
from engine.scene.collision import Collision

BAD_DISK = Path("/proc/self/mem")
"""Linux answers a read of its first byte with EIO, as a disk that fails."""


def write_job(directory: Path, **changes: Any) -> Path:
    """A directory with a collision of 2 x 60 particles that takes a few seconds."""
    settings = {"velocity": 200.0, "angle": 15.0, "particles": 60, "start_separation": 1.2, "end_time": 400.0}
    scene = Collision.model_validate({**settings, "output": {"history_interval": 50.0}, **changes}).scene()
    directory.mkdir(parents=True)
    (directory / "scene.json").write_text(scene.canonical(), encoding="utf-8")
    return directory


def engine_command(directory: Path, *options: str) -> list[str]:
    return [sys.executable, "-m", "engine", "run", str(directory), "--threads", "1", *options]


def run_engine(directory: Path, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(engine_command(directory, *options), capture_output=True, text=True, timeout=300, check=False)


def start_and_stop(directory: Path, number: signal.Signals, *options: str) -> int:
    """Run with constant checkpoints and send a signal once the second one is there."""
    command = engine_command(directory, "--checkpoint-interval", "0", *options)
    process = subprocess.Popen(command, stderr=subprocess.PIPE)
    job = JobDirectory(directory)
    while not job.previous_checkpoint.exists():
        assert process.poll() is None, "the run ended before it could be stopped"
        time.sleep(0.005)
    process.send_signal(number)
    process.communicate(timeout=60)
    return process.returncode


def assert_same_results(one: Path, other: Path) -> None:
    """History and final state of two jobs agree bit for bit."""
    for name in ("history.nc", "final.nc"):
        assert_same(read_dataset(one / name), read_dataset(other / name))


def assert_same(one: xr.Dataset, other: xr.Dataset) -> None:
    assert set(one.variables) == set(other.variables)
    for name in one.variables:
        np.testing.assert_array_equal(one[name].values, other[name].values, err_msg=str(name))
