"""The state of a campaign on screen, with an estimate of what is left: a live table, or plain lines."""

import math
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from campaigns.job_state import TrackedJob
from engine.job.directory import JobState, Status

Show = Callable[[Sequence[TrackedJob]], None]
"""Shows how all jobs stand now."""

PLAIN_PERIOD = 30.0
"""Time [s] between two plain lines on the whole campaign."""

_COLOURS = {
    JobState.DONE: "green",
    JobState.RUNNING: "cyan",
    JobState.FAILED: "red",
    JobState.INTERRUPTED: "yellow",
    JobState.UNREADABLE: "magenta",
    JobState.CORRUPT: "magenta",
}
_SHOWN_FIRST = (
    JobState.RUNNING,
    JobState.CORRUPT,
    JobState.UNREADABLE,
    JobState.FAILED,
    JobState.INTERRUPTED,
    JobState.PENDING,
    JobState.DONE,
)
"""Order of the jobs in the live table."""
_FRAME = 5
"""Lines of the live table that are not jobs."""


@contextmanager
def display(console: Console) -> Iterator[Show]:
    """A table redrawn in place, or plain lines, whichever suits the console."""
    if not console.is_terminal:
        yield PlainLines().show
        return
    with Live(console=console, auto_refresh=False, transient=True) as live:
        yield lambda jobs: live.update(_screen(jobs, console.height - _FRAME), refresh=True)


class PlainLines:
    """One line when a job changes its state, and one on the whole campaign now and then."""

    def __init__(self) -> None:
        self._states: dict[str, str] = {}
        self._next_total = 0.0

    def show(self, jobs: Sequence[TrackedJob]) -> None:
        """Print what changed since the last time."""
        for job in jobs:
            if self._states.setdefault(job.id, job.status.state) != job.status.state:
                print(line(job), flush=True)
            self._states[job.id] = job.status.state
        if time.monotonic() >= self._next_total:
            print(total(jobs), flush=True)
            self._next_total = time.monotonic() + PLAIN_PERIOD


def show_once(console: Console, jobs: Sequence[TrackedJob]) -> None:
    """Print all jobs, as a table or as plain lines, and their total."""
    if console.is_terminal:
        console.print(table(jobs))
    else:
        print("\n".join(line(job) for job in jobs))
    print(total(jobs))


def line(job: TrackedJob) -> str:
    """One job in one line."""
    reason = f": {job.status.reason}" if job.status.reason else ""
    return f"{job.id}  {job.status.state}  {percent(job.status):.0f} %{reason}"


def total(jobs: Sequence[TrackedJob]) -> str:
    """The whole campaign in one line."""
    statuses = [job.status for job in jobs]
    left = time_left(statuses)
    return count_by_state(statuses) + (f"; about {duration(left)} left" if left > 0.0 else "")


def table(jobs: Sequence[TrackedJob]) -> Table:
    """One row a job."""
    rows = Table("job", "state", "", "simulated", "steps/s", "left", "reason", box=None)
    for job in jobs:
        rows.add_row(*_cells(job))
    return rows


def _screen(jobs: Sequence[TrackedJob], room: int) -> Group:
    """As many jobs as there is room for, running ones first, and the total."""
    chosen = sorted(jobs, key=lambda job: _SHOWN_FIRST.index(job.status.state))[: max(1, room)]
    hidden = len(jobs) - len(chosen)
    return Group(table(chosen), *([f"{hidden} more jobs not shown"] if hidden else []), total(jobs))


def _cells(job: TrackedJob) -> tuple[Text | ProgressBar, ...]:
    status = job.status
    running = status.state == JobState.RUNNING
    return (
        Text(job.id),
        Text(status.state, style=_COLOURS.get(status.state, "dim")),
        ProgressBar(completed=percent(status), width=20),
        Text(f"{status.time:.0f} s" if status.step else "", justify="right"),
        Text(f"{status.steps_per_second:.1f}" if running else "", justify="right"),
        Text(duration(status.time_left) if running else "", justify="right"),
        Text(status.reason),
    )


def time_left(statuses: Sequence[Status]) -> float:
    """Wall time [s] to the end of all jobs, taking those not started as long as the others; NaN when unknown."""
    known = (JobState.RUNNING, JobState.DONE)
    started = [status for status in statuses if status.wall_time > 0.0 and status.state in known]
    pending = sum(status.state == JobState.PENDING for status in statuses)
    if pending and not started:
        return math.nan
    usual = sum(status.wall_time + _left(status) for status in started) / max(1, len(started))
    running = sum(status.state == JobState.RUNNING for status in statuses)
    return (sum(map(_left, statuses)) + pending * usual) / max(1, running)


def _left(status: Status) -> float:
    return status.time_left if status.state in (JobState.RUNNING, JobState.INTERRUPTED) else 0.0


def percent(status: Status) -> float:
    """Fraction of the simulated time that is done [%], within 0 and 100."""
    progress = 1.0 if status.state == JobState.DONE else status.progress
    return 100.0 * min(max(progress, 0.0), 1.0) if math.isfinite(progress) else 0.0


def duration(seconds: float) -> str:
    """A time as h:mm:ss; `?` when it is not known."""
    return str(timedelta(seconds=round(seconds))) if 0.0 <= seconds < 1e9 else "?"


def count_by_state(statuses: Sequence[Status]) -> str:
    """How many jobs are in each state: `3 done, 1 failed`."""
    counts = Counter(status.state for status in statuses)
    return ", ".join(f"{counts[state]} {state}" for state in JobState if counts[state])
