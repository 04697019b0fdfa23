"""The command line: what it refuses, and with which exit code."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from engine.cli import application, progress_line
from engine.device.options import VARIABLE, chosen
from engine.errors import MEMORY_IS_FULL, ExitCode
from engine.job.directory import JobDirectory, Status
from engine.simulation.simulation import Simulation
from tests.helpers.jobs import write_job


@pytest.fixture
def runner(monkeypatch: pytest.MonkeyPatch) -> CliRunner:
    """Commands choose a precision for the whole process."""
    monkeypatch.setenv(VARIABLE, "f64")
    return CliRunner()


@pytest.mark.parametrize(
    ("command", "told"),
    [
        (["verify", "slop"], "unknown problem 'slop'"),
        (["accuracy", ".", "slop"], "unknown scene 'slop'"),
        (["stability", "."], ".: exists already; name a new directory"),
        (["run", "absent"], "absent"),
        (["explain", "absent.toml"], "absent.toml"),
    ],
)
def test_what_cannot_be_used_is_named(runner: CliRunner, command: list[str], told: str) -> None:
    result = runner.invoke(application, command)
    assert result.exit_code == ExitCode.BAD_INPUT and told in result.output


def test_a_job_that_another_process_runs_has_an_exit_code_of_its_own(runner: CliRunner, tmp_path: Path) -> None:
    directory = write_job(tmp_path / "job")
    with JobDirectory(directory).claim():
        result = runner.invoke(application, ["run", str(directory)])
    assert result.exit_code == ExitCode.BUSY and "already being run" in result.output


FULL = (
    "[runtime.cpp:add_root_buffer@739] Failed to allocate root buffer",
    "[cuda_driver.h:operator()@92] CUDA Error CUDA_ERROR_OUT_OF_MEMORY: out of memory while calling mem_alloc",
)
"""What Taichi says on a device without room."""


@pytest.mark.parametrize("words", FULL)
@pytest.mark.parametrize("command", ["run", "explain"])
def test_a_device_without_room_is_told_with_what_to_do(
    runner: CliRunner, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: str, command: str
) -> None:
    """The job is interrupted, not failed: it can be run again."""
    directory = write_job(tmp_path / "job")

    def no_room(*given: object) -> None:
        raise RuntimeError(words)

    monkeypatch.setattr(Simulation, "__init__", no_room)
    result = runner.invoke(application, [command, str(directory)])
    assert result.exit_code == ExitCode.FAILED and "the memory of the device is full" in result.output
    if command == "run":
        status = JobDirectory(directory).status()
        assert (status.state, status.reason) == ("interrupted", MEMORY_IS_FULL)


def test_other_errors_are_not_taken_for_a_device_without_room(
    runner: CliRunner, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*given: object) -> None:
        raise RuntimeError("something else")

    monkeypatch.setattr(Simulation, "__init__", broken)
    result = runner.invoke(application, ["run", str(write_job(tmp_path / "job"))])
    assert isinstance(result.exception, RuntimeError) and str(result.exception) == "something else"


@pytest.mark.parametrize("command", [["verify", "slop"], ["accuracy", ".", "slop"], ["stability", "."]])
@pytest.mark.parametrize("left_behind", ["f32", "f16"])
def test_commands_without_a_scene_of_their_own_compute_in_double_precision(
    command: list[str], left_behind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(VARIABLE, left_behind)
    assert CliRunner().invoke(application, command).exit_code == ExitCode.BAD_INPUT
    assert chosen() == "f64"


def test_progress_is_one_line() -> None:
    status = Status("running", time=30.0, start_time=-10.0, end_time=70.0, step=12, steps_per_second=4.2, time_left=9.6)
    assert progress_line(status) == "t = 30 of 70 s (50 %), step 12, 4 steps/s, 10 s left"
