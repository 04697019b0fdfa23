"""Single precision: a process takes it up before it builds its device modules, so each run is one of its own."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from engine.device.options import VARIABLE
from engine.job.storage import read_dataset
from tests.helpers.jobs import assert_same_results, run_engine, start_and_stop, write_job

SINGLE = {"numerics": {"precision": "f32"}}


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An uninterrupted run on one thread."""
    directory = write_job(tmp_path_factory.mktemp("single") / "job", **SINGLE)
    result = run_engine(directory)
    assert result.returncode == 0, result.stderr
    return directory


def test_the_device_computes_in_the_precision_of_the_scene(reference: Path, tmp_path: Path) -> None:
    sessions = json.loads((reference / "provenance.json").read_text(encoding="utf-8"))["sessions"]
    assert sessions[0]["precision"] == "f32"
    final = read_dataset(reference / "final.nc")
    for name in ("position", "velocity", "J", "energy"):
        values = final[name].values
        assert values.dtype == np.float64 and np.isfinite(values).all()
    position, velocity = final["position"].values, final["velocity"].values
    assert np.array_equal(velocity, velocity.astype(np.float32))
    assert not np.array_equal(position, position.astype(np.float32)), "what is added up over all steps is double"
    double = write_job(tmp_path / "job")
    assert run_engine(double).returncode == 0
    assert not np.array_equal(velocity, read_dataset(double / "final.nc")["velocity"].values)


def test_two_threads_give_the_bits_of_one(tmp_path: Path, reference: Path) -> None:
    directory = write_job(tmp_path / "job", **SINGLE)
    assert run_engine(directory, "--threads", "2").returncode == 0
    assert_same_results(directory, reference)


def test_a_killed_run_resumes_to_the_same_bits(tmp_path: Path, reference: Path) -> None:
    directory = write_job(tmp_path / "job", **SINGLE)
    assert start_and_stop(directory, signal.SIGKILL) == -signal.SIGKILL
    assert run_engine(directory).returncode == 0
    assert "resumed" in (directory / "log.txt").read_text()
    assert_same_results(directory, reference)


def test_momentum_is_kept_to_single_precision(reference: Path) -> None:
    history = read_dataset(reference / "history.nc")
    drift = np.linalg.norm(history["momentum"].values - history["momentum"].values[0], axis=1).max()
    size = float(np.sqrt(2.0 * history["kinetic_energy"].values[0] * history["mass"].values[0]))
    # round-off of 200 steps, far above that of double precision
    assert 1e-12 * size < drift < 1e-5 * size


def test_what_single_precision_must_hold() -> None:
    command = [sys.executable, "-m", "pytest", str(Path(__file__).parent / "single_precision_cases.py")]
    result = subprocess.run(command, env={**os.environ, VARIABLE: "f32"}, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout
