"""Sharing the cores among jobs, and the cluster on this machine."""

import warnings

import pytest

from campaigns import cluster
from campaigns.cluster import Resources, connect, share_cores


@pytest.mark.parametrize(
    ("unfinished", "workers", "threads", "expected"),
    [
        (72, None, None, (8, 1)),
        (8, None, None, (8, 1)),
        (3, None, None, (4, 2)),
        (1, None, None, (1, 8)),
        (0, None, None, (1, 8)),
        (72, None, 2, (4, 2)),
        (72, None, 16, (1, 16)),
        (72, 2, None, (2, 4)),
        (72, 20, None, (20, 1)),
        (72, 3, 5, (3, 5)),
    ],
)
def test_share_cores(unfinished, workers, threads, expected, monkeypatch):
    monkeypatch.setattr(cluster, "CPU_COUNT", 8)
    assert share_cores(unfinished, workers, threads) == expected


def test_a_machine_that_slept_keeps_its_workers():
    with connect(Resources(workers=1, threads=1)) as client:
        scheduler = client.cluster.scheduler
        for worker in scheduler.workers.values():
            worker.last_seen -= 1e6
        if scheduler.worker_ttl:
            client.sync(scheduler.check_worker_ttl)
        assert client.submit(int, 1).result(timeout=10) == 1


def test_two_campaigns_at_once_warn_of_nothing():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with connect(Resources(workers=1, threads=1)) as one, connect(Resources(workers=1, threads=1)) as other:
            assert one.submit(int, 1).result(timeout=10) == other.submit(int, 1).result(timeout=10) == 1
