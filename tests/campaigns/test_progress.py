"""How much is left, and numbers in words."""

import math
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rich.console import Console

from campaigns.job_state import TrackedJob, decide
from campaigns.progress import PlainLines, count_by_state, duration, line, percent, show_once, time_left, total
from engine.job.directory import WRITTEN, JobState, Status

ANY_NUMBER = st.floats(allow_nan=True, allow_infinity=True)
ANY_STATUS = st.builds(
    Status,
    state=st.sampled_from([*WRITTEN, JobState.UNREADABLE, JobState.CORRUPT]),
    reason=st.sampled_from(["", "[bold]a[/] reason", "a " * 200]),
    time=ANY_NUMBER,
    end_time=ANY_NUMBER,
    step=st.integers(0, 10**9),
    wall_time=ANY_NUMBER,
    steps_per_second=ANY_NUMBER,
    time_left=ANY_NUMBER,
)


def test_pending_jobs_take_as_long_as_the_others():
    statuses = [
        Status(state="done", wall_time=100.0),
        Status(state="running", wall_time=50.0, time_left=50.0),
        Status(state="running", wall_time=20.0, time_left=80.0),
        Status(state="pending"),
    ]
    assert time_left(statuses) == pytest.approx((50.0 + 80.0 + 100.0) / 2)


def test_time_left_is_unknown_before_anything_ran():
    assert math.isnan(time_left([Status(state="pending")]))
    assert "left" not in total([TrackedJob(Path("a"), Status(state="pending"))])


def test_nothing_is_left_when_all_is_done():
    assert time_left([Status(state="done", wall_time=5.0), Status(state="failed")]) == 0.0


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.4, "0:00:00"), (3725.0, "1:02:05"), (math.nan, "?"), (math.inf, "?"), (-1.0, "?")]
)
def test_duration(seconds, words):
    assert duration(seconds) == words


def test_counts_leave_out_empty_states():
    assert count_by_state([Status(state="done"), Status(state="failed"), Status(state="done")]) == "2 done, 1 failed"


@settings(max_examples=50, deadline=None)
@given(st.lists(ANY_STATUS, max_size=4))
def test_any_status_can_be_shown(statuses):
    jobs = [TrackedJob(Path("jobs/v0100_a05-01234567"), status) for status in statuses]
    show_once(Console(force_terminal=True, width=100), jobs)
    show_once(Console(force_terminal=False), jobs)
    for job in jobs:
        assert 0.0 <= percent(job.status) <= 100.0
        assert job.id in line(job)
        assert decide(job.status, False).reason


def test_plain_lines_tell_changes_once(capsys):
    lines = PlainLines()
    pending, done = (TrackedJob(Path("a"), Status(state=state)) for state in ("pending", "done"))
    for job in (pending, pending, done, done):
        lines.show([job])
    assert capsys.readouterr().out.splitlines() == ["1 pending", "a  done  100 %"]
