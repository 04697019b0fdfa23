"""Stands in for `python -m engine`: counts to ten in a job directory, with the engine's files and exit codes.

FAKE_SECONDS is how long a whole job takes. A job whose name contains FAKE_FAULT fails, FAKE_CRASH kills itself,
FAKE_REFUSAL finds its input bad, FAKE_BAD_DISK cannot read its checkpoint.
"""

import fcntl
import json
import os
import signal
import socket
import sys
import time
from pathlib import Path

import psutil

STEPS = 10


def write(path: Path, text: str) -> None:
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text)
    partial.replace(path)


def write_status(job: Path, state: str, step: int, reason: str = "") -> None:
    process = psutil.Process()
    content = {
        "state": state,
        "reason": reason,
        "time": float(step),
        "end_time": float(STEPS),
        "step": step,
        "wall_time": 1.0 + step,
        "time_left": float(STEPS - step),
        "heartbeat": time.time(),
        "host": socket.gethostname(),
        "pid": process.pid,
        "process_start": process.create_time(),
    }
    write(job / "status.json", json.dumps(content))


def is_asked(job: Path, what: str) -> bool:
    return os.environ.get(f"FAKE_{what}", "nothing") in job.name


def is_done(job: Path) -> bool:
    status = job / "status.json"
    return (job / "final.nc").is_file() and json.loads(status.read_text())["state"] == "done"


def run(job: Path) -> int:
    if is_done(job):
        return 0
    checkpoint = job / "checkpoint.nc"
    first = int(checkpoint.read_text()) if checkpoint.is_file() else 0
    with (job / "log.txt").open("a") as log:
        log.write(f"from step {first}\n")
    if is_asked(job, "REFUSAL"):
        print("scene.json: 'velocity': not today", file=sys.stderr)
        return 2
    if is_asked(job, "BAD_DISK"):
        print("checkpoint.nc: Input/output error: cannot be read now", file=sys.stderr)
        return 1
    for step in range(first, STEPS):
        write(checkpoint, str(step))
        write_status(job, "running", step)
        time.sleep(float(os.environ.get("FAKE_SECONDS", "0")) / STEPS)
        if is_asked(job, "CRASH"):
            os.kill(os.getpid(), signal.SIGKILL)
        if is_asked(job, "FAULT"):
            write_status(job, "failed", step, "particle 7 left the range at step 0")
            return 1
    (job / "final.nc").write_text((job / "scene.json").read_text())
    write_status(job, "done", STEPS)
    return 0


def stop(number: int, frame: object) -> None:
    sys.exit(128 + number)


def main(job: Path) -> int:
    signal.signal(signal.SIGTERM, stop)
    with (job / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return 3
        return run(job)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[2])))
