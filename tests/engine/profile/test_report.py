"""What a scene uses and costs, as the command line tells it."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from engine.cli import application
from engine.errors import ExitCode
from engine.job.checkpoint import save_checkpoint
from engine.job.directory import JobDirectory
from engine.profile.report import size
from engine.verification.problems.column import StandingWave
from tests.helpers.scenes import started


def explain(path: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "engine", "explain", str(path), "--threads", "1", *options]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


def contents(directory: Path) -> dict[str, tuple[int, bytes]]:
    return {path.name: (path.stat().st_mtime_ns, path.read_bytes()) for path in directory.iterdir() if path.is_file()}


def test_a_column_is_explained_without_what_it_leaves_out(tmp_path):
    (tmp_path / "column.json").write_text(StandingWave(8).scene.canonical())
    result = explain(tmp_path / "column.json", "--steps", "7")
    assert result.returncode == 0, result.stderr
    text = " ".join(result.stdout.split())
    assert "256 particles" in text and "7 steps measured from t = " in text
    assert "nor run: strength, fracture, gravity, viscosity, uniform_gravity, walls." in text
    # 1024 places for vectors of six numbers and for motions of twelve; seven runs of each kernel
    assert re.search(r"shear │ Hencky │ b_minus_I │ 48\.0 KiB", text)
    assert re.search(r"scheme │ Filtered │ kicked, remainder │ 96\.0 KiB each", text)
    for kernel in ("particles_to_grid", "update_grid", "grid_to_particles"):
        assert len(re.findall(rf"{kernel} │ 7 │ \d+\.\d+ │ \d+\.\d+", text)) == 3
    assert re.search(r"drift │ Drift │ │ │ move │ 14 │ \d+\.\d+", text)
    for absent in ("damage_root", "acceleration", "BarnesHut", "Fracture"):
        assert absent not in text
    assert [path.name for path in tmp_path.iterdir()] == ["column.json"]


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("finished", [False, True])
def test_a_job_is_explained_from_its_checkpoint_and_left_alone(tmp_path, finished):
    """From its start again where the checkpoint is the end."""
    given = StandingWave(8).scene
    (tmp_path / "scene.json").write_text(given.canonical())
    simulation = started(given)
    simulation.advance(given.end_time, steps=64 if finished else 3)
    assert simulation.finished == finished
    save_checkpoint(JobDirectory(tmp_path), simulation, {})
    before = contents(tmp_path)
    result = explain(tmp_path, "--steps", "2")
    assert result.returncode == 0, result.stderr
    begun = float(re.search(r"2 steps measured from t = (\S+) s", result.stdout)[1])
    assert (begun > simulation.time) == (not finished)
    assert contents(tmp_path) == before


@pytest.mark.parametrize("content", ["bodies = [", "end_time = 1.0"])
def test_what_is_no_scene_is_refused(tmp_path, content):
    (tmp_path / "scene.toml").write_text(content)
    for path in (tmp_path, tmp_path / "scene.toml"):
        result = CliRunner().invoke(application, ["explain", str(path)])
        assert result.exit_code == ExitCode.BAD_INPUT
        assert "scene.toml" in result.output and "Traceback" not in result.output


def test_sizes_read_easily():
    assert [size(count) for count in (8, 1024, 1536, 3 * 2**20, 2**31)] == [
        "8 B",
        "1.0 KiB",
        "1.5 KiB",
        "3.0 MiB",
        "2.0 GiB",
    ]
