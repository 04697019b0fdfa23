"""Running a campaign: submit unfinished jobs to the cluster, read from disk how they stand, stop in order."""

import signal
import sys
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

from dask.distributed import Client, Future

from campaigns.campaign import Campaign
from campaigns.devices import RESOURCE
from campaigns.directory import CampaignDirectory
from campaigns.job_state import TrackedJob, decide, states
from campaigns.progress import Show
from campaigns.worker import EngineExit, run_job, signal_jobs
from engine.device.options import Arch
from engine.errors import ExitCode
from engine.job.directory import JobState

PERIOD = 1.0
"""Time [s] between two polls of the job directories."""
STOP_PATIENCE = 30.0
"""Time [s] that engines have to write their checkpoint before they are killed."""
IDLE_POLLS = 3
"""Polls in a row without a running engine after which all count as ended; a cancelled job may begin after the first."""


@dataclass
class CampaignRun:
    """One attempt at every unfinished job of a campaign.

    Attributes:
        directory, campaign: what is run.
        client: of the cluster that runs it.
        threads: CPU threads of one job.
        arch: where the engine computes.
        gpu_share: part of a GPU that a job takes; 0 on the CPU.
        retry_failed: run failed jobs once more.
    """

    directory: CampaignDirectory
    campaign: Campaign
    client: Client
    threads: int
    arch: Arch
    gpu_share: float
    retry_failed: bool
    _futures: dict[Path, Future] = field(default_factory=dict)
    _outcomes: dict[Path, EngineExit] = field(default_factory=dict)

    def watch(self, show: Show) -> list[TrackedJob]:
        """Run until no job is left to run and none is being run by another process, and return how they stand.

        A job is tried once; one that another process gives up is taken over.

        Raises:
            KeyboardInterrupt: the user stopped the campaign; the engines have ended.
        """
        try:
            while True:
                jobs = self._poll()
                show(jobs)
                if not self._futures and not any(job.status.state == JobState.RUNNING for job in jobs):
                    return jobs
                time.sleep(PERIOD)
        except BaseException:
            self._stop()
            raise

    def _poll(self) -> list[TrackedJob]:
        """Gather the tasks that ended, read how the jobs stand, and submit those that are left."""
        self._gather()
        jobs = states(self.directory, self.campaign)
        for job in jobs:
            self._submit(job)
        return [self._with_reason(job) for job in jobs]

    def _submit(self, job: TrackedJob) -> None:
        untried = job.directory not in self._futures and job.directory not in self._outcomes
        if untried and decide(job.status, self.retry_failed).runs:
            needed = {RESOURCE: self.gpu_share} if self.gpu_share else None
            self._futures[job.directory] = self.client.submit(
                run_job, job.directory, self.threads, self.arch, self.retry_failed, pure=False, resources=needed
            )

    def _gather(self) -> None:
        for path in [path for path, future in self._futures.items() if future.done()]:
            outcome = _outcome(self._futures.pop(path))
            if outcome.code != ExitCode.BUSY:
                self._outcomes[path] = outcome

    def _with_reason(self, job: TrackedJob) -> TrackedJob:
        """The job with the reason that its process gave, where its status has none, or that of an earlier session."""
        outcome = self._outcomes.get(job.directory)
        if outcome is None or job.status.state in (JobState.DONE, JobState.RUNNING):
            return job
        is_older = job.status.state == JobState.INTERRUPTED and outcome.code == ExitCode.FAILED
        if job.status.reason and not is_older:
            return job
        return replace(job, status=replace(job.status, reason=outcome.reason))

    def _stop(self) -> None:
        """Stop the engines so that each writes its checkpoint, also those that begin meanwhile."""
        print("stopping: the jobs that run write their checkpoints", file=sys.stderr)
        paths = list(self._futures)
        self.client.cancel(list(self._futures.values()))
        deadline = time.monotonic() + STOP_PATIENCE
        idle = 0
        while idle < IDLE_POLLS:
            idle = 0 if any(self.client.run(signal_jobs, paths, signal.SIGTERM).values()) else idle + 1
            time.sleep(0.2)
            if time.monotonic() > deadline:
                self.client.run(signal_jobs, paths, signal.SIGKILL)


def _outcome(future: Future) -> EngineExit:
    """How a task ended that the cluster is done with."""
    match future.status:
        case "finished":
            outcome: EngineExit = future.result()
            return outcome
        case "error":
            return EngineExit(1, f"could not be run: {future.exception()}")
        case _:
            return EngineExit(1, f"could not be run: {future.status} by the cluster")
