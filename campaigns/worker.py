"""One job on a worker: a subprocess that runs the engine, and its end in words."""

import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from campaigns.job_state import decide, status_of
from campaigns.parent_death import tethered
from engine.errors import ExitCode

ENGINE = (sys.executable, "-m", "engine")
"""Command that runs one job directory."""
_TAIL = 2000
"""Bytes of error output that are searched for the last line."""

_running: dict[Path, subprocess.Popen[bytes]] = {}
_signalled: set[tuple[subprocess.Popen[bytes], int]] = set()
"""Who got which signal: a second one might end an engine that writes its checkpoint after the first."""


@dataclass(frozen=True)
class Outcome:
    """How a job ended on a worker.

    code: exit code of the engine; negative for a signal.
    reason: what went wrong, in one line; empty when nothing did.
    """

    code: int
    reason: str = ""


def run_job(directory: Path, threads: int, arch: str, retry_failed: bool) -> Outcome:
    """Run the engine on a job, unless by now nothing is left to do there.

    Args:
        directory: the job directory.
        threads: CPU threads of the engine.
        arch: Taichi architecture, `cpu` or `cuda`.
        retry_failed: run the job although it failed before.
    """
    if not decide(status_of(directory), retry_failed).runs:
        return Outcome(ExitCode.BUSY)
    command = [*ENGINE, "run", str(directory), "--threads", str(threads), "--arch", arch]
    with tempfile.TemporaryFile() as errors, _started(directory, command, errors) as process:
        code = process.wait()
        return Outcome(code, _reason(code, errors))


def signal_jobs(directories: list[Path], number: int) -> int:
    """Send a signal, once, to each engine of these jobs on this worker; how many of them still run."""
    processes = [process for directory, process in list(_running.items()) if directory in directories]
    alive = [process for process in processes if process.poll() is None]
    for process in alive:
        if (process, number) not in _signalled:
            _signalled.add((process, number))
            process.send_signal(number)
    return len(alive)


@contextmanager
def _started(directory: Path, command: list[str], errors: IO[bytes]) -> Iterator[subprocess.Popen[bytes]]:
    """The running command, in a process group of its own so that Ctrl-C reaches only the campaign."""
    process = subprocess.Popen(
        tethered(command), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors, process_group=0
    )
    _running[directory] = process
    try:
        yield process
    finally:
        del _running[directory]


def _reason(code: int, errors: IO[bytes]) -> str:
    """Why the engine ended with `code`."""
    if code == 0:
        return ""
    if code < 0:
        return f"stopped by {signal.Signals(-code).name}"
    errors.seek(max(0, errors.seek(0, 2) - _TAIL))
    lines = errors.read().decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else f"the engine ended with code {code}"
