"""The engines that one dask worker runs: a subprocess for each job, and its end in words."""

import signal
import subprocess
import sys
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Protocol

from dask.distributed import WorkerPlugin, get_worker

from campaigns.devices import one_device
from campaigns.job_state import decide, status_of
from campaigns.parent_death import tethered
from engine.device.options import Arch
from engine.errors import ExitCode
from engine.job.directory import JobState

ENGINE = (sys.executable, "-m", "engine")
"""Command that runs one job directory."""
_TAIL = 2000
"""Bytes at the end of the error output in which the last line is sought."""


@dataclass(frozen=True)
class EngineExit:
    """How a job ended on a worker.

    Attributes:
        code: exit code of the engine; negative for a signal.
        reason: what went wrong, in one line; empty when nothing did.
    """

    code: int
    reason: str = ""


class Worker(WorkerPlugin):  # type: ignore[misc]  # dask has no types
    """The engines of one dask worker, for all campaigns that use it."""

    name = "engines"
    idempotent = True  # a second campaign must not replace the worker on which engines of the first run

    def __init__(self) -> None:
        self._running: dict[subprocess.Popen[bytes], Path] = {}
        self._signalled: set[tuple[subprocess.Popen[bytes], int]] = set()

    def run(self, directory: Path, threads: int, arch: Arch, retry_failed: bool) -> EngineExit:
        """Run the engine on a job, unless nothing is left to do there; arguments as `run_job`."""
        status = status_of(directory)
        if not decide(status, retry_failed).runs:
            seen_here = status.state in (JobState.UNREADABLE, JobState.CORRUPT)
            return EngineExit(ExitCode.FAILED, status.reason) if seen_here else EngineExit(ExitCode.BUSY)
        command = [*ENGINE, "run", str(directory), "--threads", str(threads), "--arch", arch]
        with (
            tempfile.TemporaryFile() as errors,
            one_device(arch) as environment,
            self._started(directory, command, errors, environment) as process,
        ):
            code = process.wait()
            return EngineExit(code, _reason(code, errors))

    def signal(self, directories: Collection[Path], number: int) -> int:
        """Send a signal to the engines of these jobs, to each engine once, and return how many of them still run.

        The same signal a second time might end an engine that writes its checkpoint after the first.
        """
        processes = [process for process, directory in list(self._running.items()) if directory in directories]
        alive = [process for process in processes if process.poll() is None]
        for process in alive:
            if (process, number) not in self._signalled:
                self._signalled.add((process, number))
                process.send_signal(number)
        return len(alive)

    @contextmanager
    def _started(
        self, directory: Path, command: list[str], errors: IO[bytes], environment: dict[str, str]
    ) -> Iterator[subprocess.Popen[bytes]]:
        """The running command, in a process group of its own so that Ctrl-C reaches only the campaign."""
        process = subprocess.Popen(
            tethered(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=errors,
            env=environment,
            process_group=0,
        )
        self._running[process] = directory
        try:
            yield process
        finally:
            del self._running[process]


class DaskWorker(Protocol):
    """What is used of a dask worker.

    Attributes:
        plugins: by name.
        state: with what the worker was started with, `total_resources`.
    """

    plugins: dict[str, Worker]
    state: Any


def run_job(directory: Path, threads: int, arch: Arch, retry_failed: bool) -> EngineExit:
    """Run the engine on a job; a task of the worker that executes it.

    Args:
        directory: the job directory.
        threads: CPU threads of the engine.
        arch: where the engine computes.
        retry_failed: run the job although it failed before.
    """
    worker: DaskWorker = get_worker()
    return worker.plugins[Worker.name].run(directory, threads, arch, retry_failed)


def resources_of(dask_worker: DaskWorker) -> dict[str, float]:
    """What a worker was started with, by name; dask passes the worker."""
    return dict(dask_worker.state.total_resources)


def signal_jobs(directories: Collection[Path], number: int, dask_worker: DaskWorker) -> int:
    """Send a signal, once, to the engines of these jobs on one worker, and return how many of them still run.

    Args:
        directories: the job directories.
        number: of the signal.
        dask_worker: the worker, given by dask under this name.
    """
    return dask_worker.plugins[Worker.name].signal(directories, number)


def _reason(code: int, errors: IO[bytes]) -> str:
    """Why the engine ended with `code`."""
    if code == 0:
        return ""
    if code < 0:
        return f"stopped by {signal.Signals(-code).name}"
    errors.seek(max(0, errors.seek(0, 2) - _TAIL))
    lines = errors.read().decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else f"the engine ended with code {code}"
