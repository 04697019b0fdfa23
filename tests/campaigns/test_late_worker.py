"""Stopping a campaign, with a cluster that begins one more job after all engines ended."""

import signal
from pathlib import Path
from typing import Any

from campaigns.runner import Run


class LateCluster:
    """Counts engines as told, and remembers the signals sent."""

    def __init__(self, alive: list[int]) -> None:
        self.alive, self.sent = alive, []

    def cancel(self, futures: list[Any]) -> None:
        """Nothing is left to cancel."""

    def run(self, function: Any, paths: list[Path], number: int) -> dict[str, int]:
        self.sent.append(number)
        return {"worker": self.alive.pop(0) if self.alive else 0}


def test_a_job_that_begins_late_is_stopped_too() -> None:
    client = LateCluster([2, 0, 1, 0])
    Run(None, None, client, threads=1, arch="cpu", retry_failed=False)._stop()
    assert not client.alive
    assert client.sent[2] == signal.SIGTERM
