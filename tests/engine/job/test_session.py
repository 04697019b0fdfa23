"""Running, killing and resuming jobs through the command line."""

import json
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from analysis.remnant.particles import snapshots
from engine import PHYSICS_VERSION
from engine.cli import application
from engine.errors import ExitCode
from engine.job.directory import JobDirectory
from engine.job.session import Options, run_job
from engine.job.storage import read_dataset, write_dataset
from engine.simulation.simulation import Simulation
from tests.helpers.jobs import (
    BAD_DISK,
    assert_same,
    assert_same_results,
    engine_command,
    run_engine,
    start_and_stop,
    write_job,
)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An uninterrupted run on one thread, without a checkpoint."""
    directory = write_job(tmp_path_factory.mktemp("reference") / "job")
    result = run_engine(directory)
    assert result.returncode == 0, result.stderr
    return directory


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that was killed after its second checkpoint; tests work on copies of it."""
    directory = write_job(tmp_path_factory.mktemp("killed") / "job")
    assert start_and_stop(directory, signal.SIGKILL) == -signal.SIGKILL
    return directory


@pytest.fixture(scope="module")
def terminated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that was asked to end after its second checkpoint, and saved its state; tests work on copies of it."""
    directory = write_job(tmp_path_factory.mktemp("terminated") / "job")
    assert start_and_stop(directory, signal.SIGTERM) == 130
    return directory


def copy_of(directory: Path, tmp_path: Path) -> Path:
    return shutil.copytree(directory, tmp_path / "job")


def refused(directory: Path) -> str:
    """What the command line says of a directory whose scene it refuses, before a process of its own would do more."""
    result = CliRunner().invoke(application, ["run", str(directory)])
    assert result.exit_code == ExitCode.BAD_INPUT
    return result.output


def test_a_run_writes_all_files_of_the_contract(reference: Path) -> None:
    names = {path.name for path in reference.iterdir()}
    expected = {"scene.json", "status.json", "log.txt", "history.nc", "final.nc", "provenance.json", "lock"}
    assert expected <= names
    assert JobDirectory(reference).status().state == "done"


def test_a_killed_run_resumes_to_the_same_bits(tmp_path: Path, reference: Path, killed: Path) -> None:
    directory = copy_of(killed, tmp_path)
    assert JobDirectory(directory).status().state == "interrupted"
    assert run_engine(directory).returncode == 0
    assert "resumed" in (directory / "log.txt").read_text()
    assert_same_results(directory, reference)


def test_a_terminated_run_saves_and_resumes_to_the_same_bits(tmp_path: Path, reference: Path, terminated: Path) -> None:
    directory = copy_of(terminated, tmp_path)
    assert run_engine(directory, "--checkpoint-interval", "0").returncode == 0
    assert_same_results(directory, reference)


def test_computing_times_add_up_over_sessions(tmp_path: Path, terminated: Path) -> None:
    directory = copy_of(terminated, tmp_path)
    job = JobDirectory(directory)
    earlier = {"wall_time": 2e6, "cpu_time": 1e6}
    write_dataset(job.checkpoint, read_dataset(job.checkpoint).assign_attrs(earlier))
    assert run_engine(directory).returncode == 0
    status = job.status()
    assert 2e6 < status.wall_time < 3e6 and 1e6 < status.cpu_time < 2e6


def test_two_threads_give_the_same_bits_as_one(tmp_path: Path, reference: Path) -> None:
    directory = write_job(tmp_path / "job")
    assert run_engine(directory, "--threads", "2").returncode == 0
    assert_same_results(directory, reference)


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.write_bytes(path.read_bytes()[:1000]),
        lambda path: write_dataset(path, read_dataset(path).isel(particle=slice(0, 50))),
        lambda path: write_dataset(path, read_dataset(path).drop_attrs()),
    ],
    ids=["truncated", "particles", "attributes"],
)
def test_a_damaged_checkpoint_falls_back_to_the_one_before(
    tmp_path: Path, reference: Path, killed: Path, damage
) -> None:
    directory = copy_of(killed, tmp_path)
    job = JobDirectory(directory)
    damage(job.checkpoint if job.checkpoint.exists() else job.previous_checkpoint)
    assert run_engine(directory).returncode == 0
    assert_same_results(directory, reference)


@pytest.mark.parametrize("name", ["checkpoint.nc", "history.nc", "status.json", "provenance.json"])
def test_a_file_that_cannot_be_read_now_stops_the_run_and_is_kept(
    tmp_path: Path, reference: Path, terminated: Path, name: str
) -> None:
    """Nothing is begun anew while the disk fails; when it is well again, the run goes on to the same bits."""
    directory = copy_of(terminated, tmp_path)
    well = directory / f"well {name}"
    (directory / name).rename(well)
    (directory / name).symlink_to(BAD_DISK)
    before = {path.name: path.read_bytes() for path in directory.glob("*.nc") if not path.is_symlink()}
    refusal = run_engine(directory)
    assert refusal.returncode == ExitCode.FAILED
    assert f"{name}: Input/output error: cannot be read now; it is kept" in refusal.stderr.replace("\n", " ")
    assert all((directory / other).read_bytes() == content for other, content in before.items())
    well.replace(directory / name)
    assert run_engine(directory).returncode == 0
    assert_same_results(directory, reference)


@pytest.mark.parametrize("damage", [Path.unlink, lambda path: path.write_bytes(path.read_bytes()[:1000])])
def test_a_run_whose_history_is_lost_starts_anew(tmp_path: Path, reference: Path, terminated: Path, damage) -> None:
    directory = copy_of(terminated, tmp_path)
    damage(JobDirectory(directory).history)
    assert run_engine(directory).returncode == 0
    assert "history.nc is lost or damaged" in (directory / "log.txt").read_text()
    assert_same_results(directory, reference)


def test_snapshots_do_not_change_the_run_between_them(tmp_path: Path, reference: Path) -> None:
    directory = write_job(tmp_path / "job", output={"history_interval": 50.0, "snapshot_interval": 100.0})
    assert run_engine(directory).returncode == 0
    assert_same(read_dataset(directory / "history.nc"), read_dataset(reference / "history.nc"))
    assert len(list((directory / "snapshots").glob("*.nc"))) >= 4


def test_every_snapshot_of_a_short_run_has_its_own_file(tmp_path: Path) -> None:
    pebble = {"radius": 1.0, "particles": 60}
    scene = {"bodies": [pebble], "end_time": 8e-4, "output": {"snapshot_interval": 1e-4}}
    (tmp_path / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    assert run_engine(tmp_path).returncode == 0
    in_order_of_names = [read_dataset(path).attrs["time"] for path in sorted((tmp_path / "snapshots").iterdir())]
    assert len(in_order_of_names) >= 4 and in_order_of_names == sorted(set(in_order_of_names))
    assert [time for time, _ in snapshots(JobDirectory(tmp_path))] == in_order_of_names


def test_a_finished_job_is_left_alone(reference: Path) -> None:
    files = [reference / name for name in ("final.nc", "history.nc", "status.json", "provenance.json")]
    before = [(path.stat().st_mtime_ns, path.read_bytes()) for path in files]
    assert run_engine(reference).returncode == 0
    assert [(path.stat().st_mtime_ns, path.read_bytes()) for path in files] == before


def test_a_job_that_another_process_runs_is_refused(tmp_path: Path) -> None:
    directory = write_job(tmp_path / "job", end_time=40000.0)
    with subprocess.Popen(engine_command(directory)) as process:
        while JobDirectory(directory).status().state != "running":
            time.sleep(0.05)
        second = run_engine(directory)
        process.kill()
    assert second.returncode == 3
    assert f"process {process.pid}" in second.stderr


def test_a_fault_ends_as_failed_with_its_reason(tmp_path: Path) -> None:
    numerics = {"cfl": 1.0, "transfer": "apic", "particles_per_cell": 4.0}
    directory = write_job(tmp_path / "job", velocity=1e6, numerics=numerics, gravity=None, contact=None)
    result = run_engine(directory)
    assert result.returncode == 1
    status = JobDirectory(directory).status()
    assert status.state == "failed"
    assert "particle" in status.reason and "try" in status.reason
    assert not (directory / "final.nc").exists()


def test_an_unforeseen_error_leaves_word_and_the_run_goes_on(
    tmp_path: Path, reference: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    directory = write_job(tmp_path / "job")
    job = JobDirectory(directory)

    def no_room(*given: object) -> None:
        raise MemoryError("no room\nat all")

    with monkeypatch.context() as patch, pytest.raises(MemoryError):
        patch.setattr(Simulation, "rebuild_blocks", no_room)
        run_job(directory, Options())
    assert (job.status().state, job.status().reason) == ("interrupted", "MemoryError: no room at all")
    assert "no_room" in caplog.text
    assert run_job(directory, Options()).state == "done"
    assert_same_results(directory, reference)


def test_a_checkpoint_of_another_scene_is_refused(tmp_path: Path, killed: Path) -> None:
    directory = copy_of(killed, tmp_path)
    other = write_job(tmp_path / "other", velocity=100.0)
    shutil.copy(other / "scene.json", directory / "scene.json")
    result = run_engine(directory)
    assert result.returncode == 2
    assert "another scene" in result.stderr


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"velocity": 100.0}, "final.nc: belongs to another scene; run the changed scene in a new directory"),
        ({}, f"final.nc: written with physics version {PHYSICS_VERSION + 1}, this is version {PHYSICS_VERSION}"),
    ],
)
def test_a_finished_job_of_another_scene_or_version_is_refused(
    tmp_path: Path, reference: Path, changes: dict[str, float], told: str
) -> None:
    directory = write_job(tmp_path / "job", **changes)
    for name in ("final.nc", "history.nc", "status.json"):
        shutil.copy(reference / name, directory / name)
    if not changes:
        other = {"physics_version": PHYSICS_VERSION + 1}
        write_dataset(directory / "final.nc", read_dataset(directory / "final.nc").assign_attrs(other))
    result = run_engine(directory)
    assert result.returncode == 2
    assert told in result.stderr


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"bodies": [{"radius": -1.0, "particles": 5}]}, "radius"),
        ({"bodies": [{"radius": 1.0, "particles": 0}]}, "particles"),
        ({"bodies": []}, "bodies"),
        ({"end_tme": 5.0}, "end_time"),
        ({"end_time": -5.0}, "end_time"),
    ],
)
def test_a_wrong_scene_is_refused_and_nothing_is_written(tmp_path: Path, change: dict[str, object], told: str) -> None:
    scene = {"bodies": [{"radius": 1.0, "particles": 5}], "end_time": 1.0, **change}
    (tmp_path / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    refusal = refused(tmp_path)
    assert told in refusal and "scene.json" in refusal
    assert [path.name for path in tmp_path.iterdir()] == ["scene.json"]


def test_a_missing_or_unreadable_scene_is_refused(tmp_path: Path) -> None:
    assert "nowhere" in refused(tmp_path / "nowhere")
    (tmp_path / "scene.toml").write_text("bodies = [", encoding="utf-8")
    assert "scene.toml" in refused(tmp_path)
