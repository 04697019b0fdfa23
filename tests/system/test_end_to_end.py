"""A small study from its file to its figures, with the real engine."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tests.helpers.jobs import assert_same_results

STUDY = """
name = "small"
[collision]
particles = 60
start_separation = 1.2
end_time = 400.0
output = { history_interval = 50.0, snapshot_interval = 100.0 }
[axes]
velocity = [100, 200]
angle = [5, 15]
"""


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", *arguments]


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("study") / "small.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def uninterrupted(study: Path) -> Path:
    """The campaign directory of a run that nothing disturbed."""
    runs = study.parent / "runs"
    subprocess.run(command("campaigns", "run", str(study), "--runs", str(runs)), check=True, timeout=300)
    return runs / "small"


def test_a_study_ends_in_results_table_and_figures(uninterrupted: Path) -> None:
    subprocess.run(command("analysis", "plots", str(uninterrupted)), check=True, timeout=120)
    results = xr.load_dataset(uninterrupted / "results.nc")
    assert dict(results.sizes) == {"velocity": 2, "angle": 2}
    assert (results["state"] == "done").all()
    assert np.isfinite(results["mass_ratio"]).all() and (results["drift_mass"] == 0.0).all()
    assert (abs(results["drift_momentum"]) < 1e-13).all()
    assert (abs(results["drift_angular_momentum"]) < 1e-4).all()
    assert (abs(results["drift_energy"]) < 3e-3).all()  # of the time step, in bodies this coarse
    figures = {path.name for path in (uninterrupted / "figures").iterdir()}
    assert {"maps.png", "shape_vs_angle.png", "remnants.png", "conservation.png"} <= figures
    assert (uninterrupted / "shape_table.csv").read_text().count("done") == 4


def test_a_killed_campaign_resumes_to_the_same_bits(study: Path, uninterrupted: Path) -> None:
    runs = study.parent / "killed"
    process = subprocess.Popen(command("campaigns", "run", str(study), "--runs", str(runs)), start_new_session=True)
    while not list(runs.glob("small/jobs/*/final.nc")):
        assert process.poll() is None
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    finished = {path: path.read_bytes() for path in runs.glob("small/jobs/*/final.nc")}
    subprocess.run(command("campaigns", "resume", str(study), "--runs", str(runs)), check=True, timeout=300)
    for path, content in finished.items():
        assert path.read_bytes() == content
    for job in (uninterrupted / "jobs").iterdir():
        assert_same_results(job, runs / "small" / "jobs" / job.name)
