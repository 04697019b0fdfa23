"""What a run would do with each job, and why."""

from dataclasses import dataclass

from engine.job.directory import Status


@dataclass(frozen=True)
class Decision:
    """Whether a job is run, and the reason in words."""

    runs: bool
    reason: str


def decide(status: Status, retry_failed: bool) -> Decision:
    """What to do with a job in this state.

    Args:
        status: how the job stands.
        retry_failed: run failed jobs once more.
    """
    note = f" ({status.reason})" if status.reason else ""
    match status.state:
        case "pending":
            return Decision(True, f"not started yet{note}")
        case "interrupted":
            return Decision(True, f"interrupted at {status.progress:.0%}{note}: goes on from its last checkpoint")
        case "failed" if retry_failed:
            return Decision(True, f"failed, tried again: {status.reason}")
        case "failed":
            return Decision(False, f"failed: {status.reason}; --retry-failed tries it again")
        case "done":
            return Decision(False, "finished")
        case "running":
            return Decision(False, f"being run by process {status.pid} on {status.host}")
        case _:
            return Decision(False, f"{status.reason}; delete the directory of this job to compute it anew")
