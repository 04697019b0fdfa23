import errno
import json
import multiprocessing
import os
import signal
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.process import BaseProcess
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Any

import pytest

from engine.errors import JobBusyError, JobError, UnavailableError
from engine.job.directory import HEARTBEAT_LIMIT, JobDirectory, Status

SPAWN = multiprocessing.get_context("spawn")


@pytest.fixture
def job(tmp_path: Path) -> JobDirectory:
    return JobDirectory(tmp_path)


def run_for_ever(path: Path, ready: Event) -> None:
    """What a run does as far as others can see."""
    job = JobDirectory(path)
    with job.claim():
        job.write_status(Status(state="running", step=7, time=5.0, end_time=10.0))
        ready.set()
        time.sleep(600.0)


def wait_for_ever(path: Path, ready: Event) -> None:
    """A run that holds the job, but has not yet said so."""
    with JobDirectory(path).claim():
        ready.set()
        time.sleep(600.0)


@contextmanager
def another(work: Callable[[Path, Event], None], job: JobDirectory) -> Iterator[BaseProcess]:
    """Another process at work on the job."""
    ready = SPAWN.Event()
    process = SPAWN.Process(target=work, args=(job.path, ready))
    process.start()
    try:
        assert ready.wait(60.0)
        yield process
    finally:
        process.kill()
        process.join()


def edit_status(job: JobDirectory, **changes: Any) -> None:
    content = json.loads(job.status_file.read_text())
    job.status_file.write_text(json.dumps({**content, **changes}))


def test_a_new_job_is_pending(job: JobDirectory):
    assert job.status() == Status(state="pending")


def test_status_carries_who_wrote_it_and_when(job: JobDirectory):
    job.write_status(Status(state="running", time=2.0, start_time=-2.0, end_time=6.0, step=3))
    status = job.status()
    assert (status.state, status.step, status.progress) == ("running", 3, 0.5)
    assert (status.pid, status.host) == (os.getpid(), socket.gethostname())
    assert abs(status.heartbeat - time.time()) < 5.0


@pytest.mark.parametrize("state", ["done", "failed", "interrupted"])
def test_an_ended_job_keeps_its_state_when_its_process_is_gone(job: JobDirectory, state: str):
    job.write_status(Status(state=state, reason="because"))
    edit_status(job, pid=2**22 + 1, heartbeat=0.0)
    assert (job.status().state, job.status().reason) == (state, "because")


def test_keys_of_a_later_version_are_ignored(job: JobDirectory):
    job.write_status(Status(state="done"))
    edit_status(job, new_key=1)
    assert job.status().state == "done"


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"5", b"{}", b"\xff\xfe", b'"done"'])
def test_a_damaged_status_is_an_error_that_names_the_file(job: JobDirectory, content: bytes):
    job.status_file.write_bytes(content)
    with pytest.raises(JobError, match=r"status\.json: damaged"):
        job.status()


def test_a_run_reads_as_running_while_its_process_lives_and_interrupted_once_it_is_killed(job: JobDirectory):
    with another(run_for_ever, job) as process:
        assert job.status().state == "running"
        os.kill(process.pid or 0, signal.SIGKILL)
        process.join()
        status = job.status()
    assert (status.state, status.step, status.time) == ("interrupted", 7, 5.0)


def test_a_killed_run_is_interrupted_before_its_parent_has_asked_for_its_exit_code(job: JobDirectory):
    with another(run_for_ever, job) as process:
        os.kill(process.pid or 0, signal.SIGKILL)
        os.waitid(os.P_PID, process.pid or 0, os.WEXITED | os.WNOWAIT)
        assert job.status().state == "interrupted"
        with job.claim():
            pass


def test_a_process_that_got_the_number_of_a_dead_one_is_not_the_run(job: JobDirectory):
    job.write_status(Status(state="running"))
    assert job.status().state == "running"
    edit_status(job, process_start=json.loads(job.status_file.read_text())["process_start"] - 100.0)
    assert job.status().state == "interrupted"


@pytest.mark.parametrize(("age", "state"), [(0.5, "running"), (1.5, "interrupted")])
def test_across_hosts_the_heartbeat_decides(job: JobDirectory, age: float, state: str):
    job.write_status(Status(state="running"))
    edit_status(job, host="elsewhere", heartbeat=time.time() - age * HEARTBEAT_LIMIT)
    assert job.status().state == state


@pytest.mark.parametrize("work", [run_for_ever, wait_for_ever])
def test_a_job_that_another_process_holds_is_refused(job: JobDirectory, work: Callable[[Path, Event], None]):
    with another(work, job), pytest.raises(JobBusyError, match="already being run"), job.claim():
        pass


def test_the_refusal_names_process_and_host(job: JobDirectory):
    with another(run_for_ever, job) as process, pytest.raises(JobBusyError) as error, job.claim():
        pass
    assert f"process {process.pid} on {socket.gethostname()}" in str(error.value)


def test_a_job_that_runs_on_another_host_is_refused(job: JobDirectory):
    job.write_status(Status(state="running"))
    edit_status(job, host="elsewhere", pid=1)
    with pytest.raises(JobBusyError, match="process 1 on elsewhere"), job.claim():
        pass


@pytest.mark.parametrize("code", [errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS])
def test_a_file_system_without_locks_is_told_from_a_busy_job(job: JobDirectory, monkeypatch, code: int):
    def refuse(*arguments: object) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr("fcntl.flock", refuse)
    told = f"lock: cannot be locked: {os.strerror(code)}; .*another file system"
    with pytest.raises(JobError, match=told) as error, job.claim():
        pass
    assert not isinstance(error.value, JobBusyError)


@pytest.mark.parametrize(
    ("code", "kind"), [(errno.EAGAIN, JobBusyError), (errno.EACCES, JobBusyError), (errno.EIO, UnavailableError)]
)
def test_a_lock_that_another_has_is_told_from_a_disk_that_fails(job: JobDirectory, monkeypatch, code: int, kind):
    def refuse(*arguments: object) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr("fcntl.flock", refuse)
    with pytest.raises(kind), job.claim():
        pass


def test_a_claim_is_free_at_once_after_its_process_was_killed(job: JobDirectory):
    with another(run_for_ever, job) as process:
        os.kill(process.pid or 0, signal.SIGKILL)
        process.join()
        with job.claim():
            assert job.status().state == "interrupted"


def test_a_claim_ends_with_its_block_even_if_that_fails(job: JobDirectory):
    with pytest.raises(ZeroDivisionError), job.claim():
        raise ZeroDivisionError
    with job.claim(), pytest.raises(JobBusyError), job.claim():
        pass


@pytest.mark.parametrize("pid", [-1, 10**30])
def test_what_is_no_process_does_not_run(tmp_path: Path, pid: int) -> None:
    job = JobDirectory(tmp_path)
    job.write_status(Status(state="running"))
    content = json.loads(job.status_file.read_text())
    job.status_file.write_text(json.dumps(content | {"pid": pid}))
    assert job.status().state == "interrupted"


def test_a_heartbeat_from_the_future_is_none(tmp_path: Path) -> None:
    job = JobDirectory(tmp_path)
    job.write_status(Status(state="running"))
    content = json.loads(job.status_file.read_text())
    job.status_file.write_text(json.dumps(content | {"host": "elsewhere", "heartbeat": time.time() + 1e6}))
    assert job.status().state == "interrupted"
