"""The directory of a campaign: campaign.json and the job directories beside it."""

from dataclasses import dataclass
from pathlib import Path

from campaigns.campaign import FILE, Campaign, Job, read_campaign
from campaigns.dotted_keys import flatten
from campaigns.expansion import scene_of
from campaigns.job_names import HASH_LENGTH
from engine.errors import SceneError
from engine.job.storage import write_json, write_text

_ELSEWHERE = "choose another results directory with RUNS=DIR (--runs DIR)"
_ANEW = "delete this file and run the study again: it is written anew, and finished jobs are kept"


@dataclass(frozen=True)
class CampaignDirectory:
    """Where the jobs of one study live."""

    path: Path

    @property
    def file(self) -> Path:
        """The campaign's description."""
        return self.path / FILE

    def read(self) -> Campaign:
        """The campaign kept here.

        Raises:
            SceneError: campaign.json is missing or damaged.
        """
        try:
            return read_campaign(self.path, Campaign)
        except SceneError as error:
            if not self.file.is_file():
                raise
            raise SceneError(f"{error}; {_ANEW}") from error

    def admit(self, campaign: Campaign) -> Campaign:
        """The campaign as it may be written here: jobs that have a directory keep its name.

        Raises:
            SceneError: the directory belongs to another study, other settings or another physics version.
        """
        names = {name[-HASH_LENGTH:]: name for name in self._job_names()}
        if self.file.is_file():
            self._require_same(self.read(), campaign)
        elif self.path.exists() and not any(job.id[-HASH_LENGTH:] in names for job in campaign.jobs):
            self._require_empty()  # jobs of this campaign are its own, also when its description is lost
        jobs = tuple(job.called(names.get(job.id[-HASH_LENGTH:], job.id)) for job in campaign.jobs)
        return campaign.model_copy(update={"jobs": jobs})

    def write(self, campaign: Campaign) -> None:
        """Write campaign.json and the scenes that are not there yet; nothing else is touched."""
        self.path.mkdir(parents=True, exist_ok=True)
        write_json(self.file, campaign.content())
        for job in campaign.jobs:
            self._write_scene(job)

    def _write_scene(self, job: Job) -> None:
        path = self.path / job.directory / "scene.json"
        if path.is_file():
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        write_text(path, scene_of(job.collision, job.id).canonical())

    def _job_names(self) -> list[str]:
        jobs = self.path / "jobs"
        return sorted(path.name for path in jobs.iterdir() if path.is_dir()) if jobs.is_dir() else []

    def _require_same(self, kept: Campaign, given: Campaign) -> None:
        if kept.name != given.name:
            raise SceneError(f"{self.path}: belongs to study '{kept.name}', not '{given.name}'; {_ELSEWHERE}")
        if kept.physics_version != given.physics_version:
            raise SceneError(
                f"{self.path}: computed with physics version {kept.physics_version}, this code has "
                f"{given.physics_version}, and results must not mix; {_ELSEWHERE}"
            )
        self._require_same_settings(kept, given)

    def _require_same_settings(self, kept: Campaign, given: Campaign) -> None:
        before = kept.study.shared_settings(str(self.file))
        now = given.study.shared_settings("collision")
        varied = flatten(kept.study.axes or {}) | flatten(given.study.axes or {})  # jobs differ in these by themselves
        changed = [key for key in sorted(before | now) if before.get(key) != now.get(key) and key not in varied]
        if changed:
            details = ", ".join(f"{key} {before.get(key)} there and {now.get(key)} in the study" for key in changed)
            raise SceneError(f"{self.path}: holds results with other settings ({details}); {_ELSEWHERE}")

    def _require_empty(self) -> None:
        if not self.path.is_dir():
            raise SceneError(f"{self.path}: is a file, not a results directory; {_ELSEWHERE}")
        if any(not path.name.startswith(".") for path in self.path.iterdir()):
            raise SceneError(f"{self.path}: holds files but no campaign.json, so it is not a campaign's; {_ELSEWHERE}")
