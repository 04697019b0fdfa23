"""Where jobs run: on this machine, on a running dask scheduler, or on SLURM."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module

import dask
from dask.distributed import Client, LocalCluster, SpecCluster
from dask.system import CPU_COUNT

from campaigns.devices import RESOURCE
from campaigns.worker import Worker, resources_of
from engine.errors import SceneError

CONNECTION_TIMEOUT = 10.0
"""Time [s] in which a scheduler must answer."""


@dataclass(frozen=True)
class Resources:
    """What a campaign may use.

    Attributes:
        workers: jobs at the same time.
        threads: CPU threads of one job.
        gpus: of this machine; 0 for jobs on the CPU.
        jobs_per_gpu: jobs at the same time on each.
        scheduler: address of a running dask scheduler; `None` starts a cluster of our own.
        slurm: let that cluster submit its workers to SLURM.
    """

    workers: int
    threads: int
    gpus: int = 0
    jobs_per_gpu: int = 1
    scheduler: str | None = None
    slurm: bool = False

    @property
    def gpu_share(self) -> float:
        """Part of a GPU that a job takes, rounded down so that all fit; 0 on the CPU."""
        return (1.0 - 1e-9) / self.jobs_per_gpu if self.gpus else 0.0


def share_cores(unfinished: int, workers: int | None, threads: int | None) -> tuple[int, int]:
    """Jobs at the same time and threads of each, such that all cores of this machine are used.

    Args:
        unfinished: jobs left to run.
        workers: jobs at the same time, if given.
        threads: threads of one job, if given.
    """
    jobs = max(1, min(unfinished, workers or CPU_COUNT))
    threads = threads or max(1, CPU_COUNT // jobs)
    return workers or max(1, CPU_COUNT // threads), threads


@contextmanager
def connect(resources: Resources) -> Iterator[Client]:
    """A client of the cluster that `resources` names, whose workers can run engines.

    Raises:
        SceneError: the scheduler does not answer or has no GPU, or SLURM support is missing or not set up.
    """
    with _client(resources) as client:
        client.register_plugin(Worker())
        if resources.scheduler and resources.gpus:
            _require_gpu(client, resources.scheduler)
        yield client


@contextmanager
def _client(resources: Resources) -> Iterator[Client]:
    if resources.scheduler:
        with _client_of(resources.scheduler) as client:
            yield client
        return
    with _slurm(resources) if resources.slurm else _local(resources) as cluster, Client(cluster) as client:
        yield client


def _local(resources: Resources) -> LocalCluster:
    """Worker threads of this process, which only wait for the engine's processes."""
    with dask.config.set({"distributed.scheduler.worker-ttl": None}):  # else a machine that slept loses its workers
        return LocalCluster(
            n_workers=1,
            threads_per_worker=resources.workers,
            processes=False,
            memory_limit=0,
            resources={RESOURCE: resources.gpus},
            dashboard_address="127.0.0.1:0",  # any port, so that two campaigns do not warn of each other
            silence_logs=logging.ERROR,
        )


def _client_of(address: str) -> Client:
    try:
        return Client(address, timeout=CONNECTION_TIMEOUT)
    except (OSError, ValueError) as error:
        raise SceneError(
            f"--scheduler {address}: cannot be reached ({error}); start one with 'dask scheduler' "
            "and workers with 'dask worker', or leave the option out"
        ) from error


def _require_gpu(client: Client, scheduler: str) -> None:
    """Refuse a scheduler all of whose workers are without GPUs: no job would ever begin."""
    found = client.run(resources_of).values()
    if found and not any(resources.get(RESOURCE) for resources in found):
        raise SceneError(
            f"--scheduler {scheduler}: none of its workers has a GPU; start them with "
            f"'dask worker --resources \"{RESOURCE}=1\"', or use --arch cpu"
        )


def _with_gpu(resources: Resources) -> dict[str, list[str]]:
    """Arguments of a SLURM cluster whose workers have one GPU each, beside those that its settings give."""
    given = dask.config.get("jobqueue.slurm.worker-extra-args", [])
    return {"worker_extra_args": [*given, "--resources", f"{RESOURCE}=1"]} if resources.gpus else {}


def _slurm(resources: Resources) -> SpecCluster:
    """Workers as SLURM jobs with one job of ours at a time; memory, queue and walltime are dask-jobqueue's settings."""
    try:
        jobqueue = import_module("dask_jobqueue")
        cluster = jobqueue.SLURMCluster(
            cores=resources.jobs_per_gpu, processes=1, job_cpu=resources.threads, **_with_gpu(resources)
        )
    except ImportError as error:
        raise SceneError("--slurm: needs dask-jobqueue; install it with: pip install -e '.[slurm]'") from error
    except ValueError as error:
        reason = " ".join(str(error).split())
        raise SceneError(f"--slurm: set jobqueue.slurm in ~/.config/dask/jobqueue.yaml: {reason}") from error
    cluster.adapt(maximum=resources.workers)
    return cluster
