"""The state of a campaign on screen: a live table, or plain lines where there is no terminal."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from campaigns.estimate import count_by_state, duration, percent, time_left
from campaigns.job_state import TrackedJob
from engine.job.directory import JobState

Show = Callable[[Sequence[TrackedJob]], None]
"""Shows how all jobs stand now."""

PLAIN_PERIOD = 30.0
"""Time [s] between two plain lines on the whole campaign."""

_COLOURS: dict[str, str] = {
    JobState.DONE: "green",
    JobState.RUNNING: "cyan",
    JobState.FAILED: "red",
    JobState.INTERRUPTED: "yellow",
    JobState.CORRUPT: "magenta",
}
_SHOWN_FIRST = (
    JobState.RUNNING,
    JobState.CORRUPT,
    JobState.FAILED,
    JobState.INTERRUPTED,
    JobState.PENDING,
    JobState.DONE,
)
_FRAME = 5
"""Lines of the live view that are not jobs."""


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
    running = status.state == "running"
    return (
        Text(job.id),
        Text(status.state, style=_COLOURS.get(status.state, "dim")),
        ProgressBar(completed=percent(status), width=20),
        Text(f"{status.time:.0f} s" if status.step else "", justify="right"),
        Text(f"{status.steps_per_second:.1f}" if running else "", justify="right"),
        Text(duration(status.time_left) if running else "", justify="right"),
        Text(status.reason),
    )
