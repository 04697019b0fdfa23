"""The job directory: its files, the process that runs it, and how far it is."""

import errno
import fcntl
import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import TextIO

import psutil
from pydantic import TypeAdapter, ValidationError

from engine.errors import Fault, JobBusyError, JobError
from engine.job.storage import NO_FILE, read_or_unavailable, remove_partial_files, write_json


class JobState(StrEnum):
    """How a job stands; only readers of a campaign see `unreadable`, `corrupt` and `missing`."""

    PENDING = "pending"
    RUNNING = "running"
    INTERRUPTED = "interrupted"
    DONE = "done"
    FAILED = "failed"
    UNREADABLE = "unreadable"
    CORRUPT = "corrupt"
    MISSING = "missing"


WRITTEN = (JobState.PENDING, JobState.RUNNING, JobState.INTERRUPTED, JobState.DONE, JobState.FAILED)
"""States that a run writes to status.json."""

HELD = (errno.EAGAIN, errno.EACCES)
"""Errors of `flock` where another process has the lock; the second is that of some network file systems."""

NO_LOCKS = (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS)
"""Errors of `flock` where the file system has no locks."""

HEARTBEAT_PERIOD = 2.0
"""Time [s] between two writes of status.json by a run."""

HEARTBEAT_LIMIT = 120.0
"""Age [s] at which the heartbeat of a run on another host counts as stopped."""


@dataclass(frozen=True)
class Status:
    """Content of status.json, as a run last wrote it.

    Attributes:
        state: one of `WRITTEN`; `JobDirectory.status` corrects that of a process that has died.
        reason: why the run ended before its end time, in one line; empty if it did not.
        fault: the reason in parts, if the guard stopped the run.
        time, start_time, end_time: simulated time [s], now, at the start and at the end.
        step: time steps done.
        wall_time: computing time [s] of all sessions of this job.
        cpu_time: processor time [s] of all their threads.
        steps_per_second: recent rate [1/s].
        time_left: estimate of the computing time to the end [s].
        heartbeat: when this was written [s since the epoch].
        host, pid, process_start: the process that wrote it.
    """

    state: JobState
    reason: str = ""
    fault: Fault | None = None
    time: float = 0.0
    start_time: float = 0.0
    end_time: float = 0.0
    step: int = 0
    wall_time: float = 0.0
    cpu_time: float = 0.0
    steps_per_second: float = 0.0
    time_left: float = 0.0
    heartbeat: float = 0.0
    host: str = ""
    pid: int = 0
    process_start: float = 0.0

    @property
    def progress(self) -> float:
        """Fraction of the simulated time that is done, 0 to 1."""
        span = self.end_time - self.start_time
        return (self.time - self.start_time) / span if span > 0.0 else 0.0


_STATUS = TypeAdapter(Status)


@dataclass(frozen=True)
class JobDirectory:
    """Files of one job.

    Attributes:
        path: the directory.
    """

    path: Path

    @property
    def status_file(self) -> Path:
        """State and progress, rewritten every few seconds."""
        return self.path / "status.json"

    @property
    def log(self) -> Path:
        """Log of all sessions."""
        return self.path / "log.txt"

    @property
    def history(self) -> Path:
        """Conserved quantities over time."""
        return self.path / "history.nc"

    @property
    def final(self) -> Path:
        """Particles at the end; exists only when the job is done."""
        return self.path / "final.nc"

    @property
    def provenance(self) -> Path:
        """Command, code, packages and device of every session."""
        return self.path / "provenance.json"

    @property
    def checkpoint(self) -> Path:
        """The last checkpoint."""
        return self.path / "checkpoint.nc"

    @property
    def previous_checkpoint(self) -> Path:
        """The checkpoint before the last."""
        return self.path / "checkpoint.previous.nc"

    @property
    def snapshots(self) -> Path:
        """Directory of particle snapshots."""
        return self.path / "snapshots"

    def snapshot(self, step: int) -> Path:
        """Particles after a number of time steps; sorted by name, snapshots are in order of time."""
        return self.snapshots / f"{step:010d}.nc"

    def status(self) -> Status:
        """Return how the job stands now: `interrupted` if its process has died, `pending` if it was never run.

        Raises:
            UnavailableError: status.json cannot be read now.
            JobError: it is damaged.
        """
        try:
            with read_or_unavailable(self.status_file):
                status = _STATUS.validate_json(self.status_file.read_bytes())
        except FileNotFoundError:
            return Status(state=JobState.PENDING)
        except ValidationError as error:
            issue = error.errors(include_url=False)[0]
            key = "".join(f"'{part}': " for part in issue["loc"])
            raise JobError(f"{self.status_file}: damaged: {key}{issue['msg']}") from error
        except NO_FILE as error:
            raise JobError(f"{self.status_file}: damaged: {error}") from error
        if status.state not in WRITTEN:
            raise JobError(f"{self.status_file}: damaged: unknown state '{status.state}'")
        if status.state == JobState.RUNNING and not _is_alive(status):
            return replace(status, state=JobState.INTERRUPTED)
        return status

    def write_status(self, status: Status) -> None:
        """Write status.json with the time and the process of this call.

        Raises:
            OSError: the file cannot be written.
        """
        process = psutil.Process()
        own = {
            "heartbeat": time.time(),
            "host": socket.gethostname(),
            "pid": process.pid,
            "process_start": process.create_time(),
        }
        write_json(self.status_file, {**asdict(status), **own})

    @contextmanager
    def claim(self) -> Iterator[None]:
        """Lock the job for this process, until the `with` block or the process ends.

        Raises:
            JobBusyError: another process runs this job.
            UnavailableError: the lock cannot be had now for another reason.
            JobError: the file system has no locks.
        """
        with (self.path / "lock").open("w") as lock:
            with read_or_unavailable(self.path / "lock"):
                self._lock(lock)
            status = self.status()
            if status.state == JobState.RUNNING and status.pid != os.getpid():
                raise self._busy(status)
            remove_partial_files(self.path)
            yield

    def _lock(self, lock: TextIO) -> None:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if error.errno in HELD:
                raise self._busy(self.status()) from error
            if error.errno in NO_LOCKS:
                raise JobError(
                    f"{lock.name}: cannot be locked: {error.strerror}; without flock two processes could run one job: "
                    "put the results on another file system, or mount this one with locks"
                ) from error
            raise

    def _busy(self, status: Status) -> JobBusyError:
        by = f" by process {status.pid} on {status.host}" if status.pid else ""
        return JobBusyError(f"{self.path}: already being run{by}; wait for it or stop it")


def _is_alive(status: Status) -> bool:
    """Whether the process that wrote a status still runs; on another host, whether its heartbeat is recent."""
    if status.host != socket.gethostname():
        return abs(time.time() - status.heartbeat) < HEARTBEAT_LIMIT
    try:
        process = psutil.Process(status.pid)
        same_process: bool = abs(process.create_time() - status.process_start) < 1.0
        return same_process and process.status() != psutil.STATUS_ZOMBIE
    except (psutil.Error, ValueError, OverflowError):  # the latter two: no number of a process
        return False
