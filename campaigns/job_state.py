"""How each job stands, read from its directory, and what a run does with it; what cannot be read is a state as well."""

from dataclasses import dataclass
from pathlib import Path

from campaigns.campaign import Campaign
from campaigns.directory import CampaignDirectory
from campaigns.job_names import belongs_to
from engine.errors import JobError, UnavailableError
from engine.job.directory import JobDirectory, JobState, Status
from engine.job.storage import NO_FILE, read_or_unavailable


@dataclass(frozen=True)
class TrackedJob:
    """One job of a campaign and how it stands.

    Attributes:
        directory: the job directory.
        status: how the job stands.
    """

    directory: Path
    status: Status

    @property
    def id(self) -> str:
        """The job's id, the name of its directory."""
        return self.directory.name


def states(directory: CampaignDirectory, campaign: Campaign) -> list[TrackedJob]:
    """Read how all jobs of a campaign stand now."""
    paths = [directory.path / job.directory for job in campaign.jobs]
    return [TrackedJob(path, status_of(path)) for path in paths]


def status_of(job_directory: Path) -> Status:
    """Read how one job stands now; it is `unreadable` or `corrupt`, with the reason, when that cannot be told."""
    try:
        with read_or_unavailable(job_directory):
            _require_own_scene(job_directory)
            return _sound_status(JobDirectory(job_directory))
    except UnavailableError as error:
        return Status(state=JobState.UNREADABLE, reason=" ".join(str(error).split()))
    except (JobError, *NO_FILE) as error:
        return Status(state=JobState.CORRUPT, reason=" ".join(str(error).split()))


def _require_own_scene(job_directory: Path) -> None:
    path = job_directory / "scene.json"
    with read_or_unavailable(path):
        if path.is_file() and not belongs_to(job_directory.name, path.read_bytes()):
            raise JobError(f"{path}: is not the scene this job was made for")


def _sound_status(job: JobDirectory) -> Status:
    status = job.status()
    if status.state == JobState.DONE and not job.final.is_file():
        raise JobError(f"{job.final}: missing, though status.json says done")
    return status


@dataclass(frozen=True)
class Decision:
    """What a run does with a job.

    Attributes:
        runs: whether the job is run.
        reason: why, in one line.
    """

    runs: bool
    reason: str


def decide(status: Status, retry_failed: bool) -> Decision:
    """Decide what to do with a job in this state.

    Args:
        status: how the job stands.
        retry_failed: run failed jobs once more.
    """
    note = f" ({status.reason})" if status.reason else ""
    match status.state:
        case JobState.PENDING:
            return Decision(True, f"not started yet{note}")
        case JobState.INTERRUPTED:
            return Decision(True, f"interrupted at {status.progress:.0%}{note}: goes on from its last checkpoint")
        case JobState.FAILED if retry_failed:
            return Decision(True, f"failed, tried again: {status.reason}")
        case JobState.FAILED:
            return Decision(False, f"failed: {status.reason}; --retry-failed tries it again")
        case JobState.DONE:
            return Decision(False, "finished")
        case JobState.RUNNING:
            return Decision(False, f"being run by process {status.pid} on {status.host}")
        case JobState.UNREADABLE:
            return Decision(False, status.reason or "cannot be read now")
        case JobState.CORRUPT | JobState.MISSING:
            return Decision(False, f"{status.reason}; move the directory of this job away to compute it anew")
