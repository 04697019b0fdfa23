"""How much computing is left."""

import math
from collections import Counter
from collections.abc import Sequence
from datetime import timedelta

from engine.job.directory import JobState, Status


def time_left(statuses: Sequence[Status]) -> float:
    """Wall time [s] to the end of all jobs, taking those not started as long as the others; NaN when unknown."""
    started = [status for status in statuses if status.wall_time > 0.0 and status.state in ("running", "done")]
    pending = sum(status.state == "pending" for status in statuses)
    if pending and not started:
        return math.nan
    usual = sum(status.wall_time + _left(status) for status in started) / max(1, len(started))
    running = sum(status.state == "running" for status in statuses)
    return (sum(map(_left, statuses)) + pending * usual) / max(1, running)


def _left(status: Status) -> float:
    return status.time_left if status.state in ("running", "interrupted") else 0.0


def percent(status: Status) -> float:
    """Share of the simulated time that is done [%], within 0 and 100."""
    progress = 1.0 if status.state == "done" else status.progress
    return 100.0 * min(max(progress, 0.0), 1.0) if math.isfinite(progress) else 0.0


def duration(seconds: float) -> str:
    """A time as h:mm:ss; `?` when it is not known."""
    return str(timedelta(seconds=round(seconds))) if 0.0 <= seconds < 1e9 else "?"


def count_by_state(statuses: Sequence[Status]) -> str:
    """How many jobs are in each state: `3 done, 1 failed`."""
    counts = Counter(status.state for status in statuses)
    return ", ".join(f"{counts[state]} {state}" for state in JobState if counts[state])
