"""Campaigns that are stopped, killed, or started twice, in processes of their own."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import psutil
import pytest

from campaigns.job_state import status_of

ROOT = Path(__file__).parents[2]
DRIVER = ROOT / "tests" / "helpers" / "campaign_driver.py"


def start(study: Path, runs: Path, verb: str = "run", seconds: float = 60.0) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, str(DRIVER), verb, str(study), "--runs", str(runs), "--workers", "2"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"FAKE_SECONDS": str(seconds), "PYTHONPATH": str(ROOT)},
        start_new_session=True,
        # a shell in the background lets its children ignore it, and they theirs
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )


def wait_for(condition: Callable[[], bool], patience: float = 20.0) -> None:
    deadline = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def jobs_in(runs: Path, state: str) -> list[Path]:
    return [path for path in sorted(runs.glob("small/jobs/*")) if status_of(path).state == state]


def engines(runs: Path) -> list[int]:
    return [status_of(path).pid for path in jobs_in(runs, "running")]


@pytest.fixture
def study(write_study) -> Path:
    """Four jobs."""
    return write_study(velocity="[100, 200, 300, 400]")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_stop_ends_the_engines_and_tells_how_to_resume(number, study, runs):
    campaign = start(study, runs)
    wait_for(lambda: len(engines(runs)) == 2)
    pids = engines(runs)
    campaign.send_signal(number)
    _, err = campaign.communicate(timeout=20)
    assert campaign.returncode == 130
    assert "make resume STUDY=" in err
    assert "Traceback" not in err
    assert not any(psutil.pid_exists(pid) for pid in pids)
    assert len(jobs_in(runs, "interrupted")) == 2
    resumed = start(study, runs, "resume", seconds=0.0)
    assert resumed.wait(timeout=60) == 0
    assert len(jobs_in(runs, "done")) == 4


def test_kill_of_the_group_then_rerun(study, runs, tree):
    first = start(study, runs, seconds=0.5)
    wait_for(lambda: len(jobs_in(runs, "done")) >= 2 and len(engines(runs)) > 0)
    os.killpg(first.pid, signal.SIGKILL)
    first.communicate()
    wait_for(lambda: not engines(runs))
    finished = {path: tree(path) for path in jobs_in(runs, "done")}
    second = start(study, runs, seconds=0.0)
    assert second.wait(timeout=60) == 0
    assert len(jobs_in(runs, "done")) == 4
    assert all(tree(path) == content for path, content in finished.items())


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ties engines to their campaign")
def test_engines_end_with_a_killed_campaign(study, runs):
    campaign = start(study, runs)
    wait_for(lambda: len(engines(runs)) == 2)
    pids = engines(runs)
    campaign.kill()
    campaign.communicate()
    wait_for(lambda: not any(psutil.pid_exists(pid) for pid in pids))
    assert len(jobs_in(runs, "interrupted")) == 2


def test_two_campaigns_at_once(study, runs):
    both = [start(study, runs, seconds=0.3) for _ in range(2)]
    assert [campaign.wait(timeout=60) for campaign in both] == [0, 0]
    assert len(jobs_in(runs, "done")) == 4
    for log in runs.glob("small/jobs/*/log.txt"):
        assert log.read_text() == "from step 0\n"


def test_second_campaign_takes_over_from_a_killed_one(study, runs):
    first = start(study, runs)
    wait_for(lambda: len(engines(runs)) == 2)
    second = start(study, runs, seconds=0.0)
    wait_for(lambda: len(jobs_in(runs, "done")) == 2)
    assert second.poll() is None
    first.kill()
    first.communicate()
    assert second.wait(timeout=60) == 0
    assert len(jobs_in(runs, "done")) == 4
