"""The engines of one worker."""

import signal
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import campaigns.worker
from campaigns.worker import EngineExit, Worker
from engine.device.options import Arch
from engine.errors import ExitCode
from engine.job.directory import JobDirectory, JobState, Status
from tests.helpers.jobs import BAD_DISK

COUNTER = """
import signal, sys, time
from pathlib import Path
job = Path(sys.argv[2])
if (job / "ready").exists():
    sys.exit(3)
signal.signal(signal.SIGTERM, lambda number, frame: (job / "signals").open("a").write("x"))
(job / "ready").touch()
while not (job / "end").exists():
    time.sleep(0.01)
sys.exit(sys.stderr.write("first\\nlast line\\n") and 5)
"""


def wait_for(path: Path) -> None:
    deadline = time.monotonic() + 20.0
    while not path.exists():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A job directory whose engine counts the signals that it receives."""
    (tmp_path / "engine.py").write_text(COUNTER)
    monkeypatch.setattr(campaigns.worker, "ENGINE", (sys.executable, str(tmp_path / "engine.py")))
    (tmp_path / "job").mkdir()
    return tmp_path / "job"


def test_each_signal_reaches_an_engine_once(job: Path) -> None:
    worker = Worker()
    with ThreadPoolExecutor(1) as pool:
        ended = pool.submit(worker.run, job, 1, Arch.CPU, False)
        wait_for(job / "ready")
        assert worker.signal([job.parent / "another"], signal.SIGTERM) == 0
        assert worker.signal([job], signal.SIGTERM) == 1
        wait_for(job / "signals")
        assert worker.signal([job], signal.SIGTERM) == 1
        time.sleep(0.1)
        (job / "end").touch()
        assert ended.result(timeout=20) == EngineExit(5, "last line")
    assert (job / "signals").read_text() == "x"
    assert worker.signal([job], signal.SIGTERM) == 0


def test_an_engine_stays_known_when_a_second_one_finds_its_job_busy(job: Path) -> None:
    worker = Worker()
    with ThreadPoolExecutor(1) as pool:
        first = pool.submit(worker.run, job, 1, Arch.CPU, False)
        wait_for(job / "ready")
        assert worker.run(job, 1, Arch.CPU, False).code == ExitCode.BUSY
        assert worker.signal([job], signal.SIGTERM) == 1
        (job / "end").touch()
        assert first.result(timeout=20) == EngineExit(5, "last line")


def test_a_job_that_another_process_runs_is_left_to_it(tmp_path: Path) -> None:
    JobDirectory(tmp_path).write_status(Status(state=JobState.RUNNING))
    assert Worker().run(tmp_path, 1, Arch.CPU, False) == EngineExit(ExitCode.BUSY)
    assert [path.name for path in tmp_path.iterdir()] == ["status.json"]


def test_a_job_that_this_worker_cannot_read_is_not_sent_to_it_again(tmp_path: Path) -> None:
    """The runner may see it well, on another machine: a busy job would be submitted for ever."""
    (tmp_path / "status.json").symlink_to(BAD_DISK)
    ended = Worker().run(tmp_path, 1, Arch.CPU, False)
    assert ended.code == ExitCode.FAILED and "status.json: Input/output error: cannot be read now" in ended.reason
