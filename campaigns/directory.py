"""The directory of a campaign: campaign.json and the job directories beside it."""

import re
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from campaigns.campaign import FILE, Campaign, Job, read_campaign
from campaigns.dotted_keys import flatten
from campaigns.expansion import scene_of
from campaigns.job_names import hash_in
from engine.errors import SceneError
from engine.job.storage import write_json, write_text

_ELSEWHERE = "choose another results directory with RUNS=DIR (--runs DIR)"
_ANEW = (
    "move this file away and run the study again with the version of the code that wrote it: it is written anew, and "
    "jobs whose ids are the same are kept"
)
_KEEP = f"of another version, or changed by hand: keep it, because it describes the jobs there, and {_ELSEWHERE}"
_MOST = 3
"""Lines or keys that a message lists."""


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
            SceneError: campaign.json is missing or damaged, or no campaign that this version can run.
        """
        try:
            return read_campaign(self.path, Campaign)
        except SceneError as error:
            if not self.file.is_file() or isinstance(error.__cause__, OSError):
                raise
            is_json = error.__cause__ is None or isinstance(error.__cause__, ValidationError)
            lines = [*_first(str(error).splitlines()), f"{self.file}: {_KEEP if is_json else _ANEW}"]
            raise SceneError("\n".join(lines)) from error

    def admit(self, campaign: Campaign) -> Campaign:
        """The campaign as it may be written here: jobs that have a directory keep its name.

        Raises:
            SceneError: the directory belongs to another study, other settings or another physics version.
        """
        names = {hash_in(name): name for name in self._job_names()}
        if self.file.is_file():
            self._require_same(self.read(), campaign)
        elif self.path.exists() and not any(hash_in(job.id) in names for job in campaign.jobs):
            self._require_empty()  # jobs of this campaign are its own, also when its description is lost
        jobs = tuple(job.called(names.get(hash_in(job.id), job.id)) for job in campaign.jobs)
        return campaign.model_copy(update={"jobs": jobs})

    def write(self, campaign: Campaign) -> None:
        """Write campaign.json and the scenes that are not there yet; nothing else is touched."""
        self.path.mkdir(parents=True, exist_ok=True)
        write_json(self.file, campaign.content())
        for job in campaign.jobs:
            self._write_scene(job)

    def _write_scene(self, job: Job) -> None:
        path = self.path / job.directory / "scene.json"
        try:
            if path.is_file():
                return
        except OSError:  # the job is `unreadable`, and the others can go on
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
        if not _hashes(kept) <= _hashes(given):  # a study with all jobs there extends it, in whatever words
            self._require_same_settings(kept, given)

    def _require_same_settings(self, kept: Campaign, given: Campaign) -> None:
        """Require that settings which are not varied are the same, as far as they reach the scenes of both studies."""
        before = kept.study.shared_settings(str(self.file))
        now = given.study.shared_settings("collision")
        varied = flatten(kept.study.axes or {}) | flatten(given.study.axes or {})  # jobs differ in these by themselves
        used = _materials(kept) & _materials(given)
        changed = [
            f"{key} {before.get(key)} there and {now.get(key)} in the study"
            for key in sorted(before | now)
            if before.get(key) != now.get(key) and key not in varied and _reaches_scenes(key, used)
        ]
        if changed:
            more = f", and {len(changed) - _MOST} more" if len(changed) > _MOST else ""
            details = ", ".join(changed[:_MOST]) + more
            raise SceneError(f"{self.path}: contains results with other settings ({details}); {_ELSEWHERE}")

    def _require_empty(self) -> None:
        if not self.path.is_dir():
            raise SceneError(f"{self.path}: is a file, not a results directory; {_ELSEWHERE}")
        if any(not path.name.startswith(".") for path in self.path.iterdir()):
            raise SceneError(
                f"{self.path}: contains files but no campaign.json, so it is not a campaign's; {_ELSEWHERE}"
            )


def _first(lines: list[str]) -> list[str]:
    """The first few lines of an error, one of those that are the same for many jobs."""
    different = list({re.sub(r"'jobs\.\d+", "'jobs", line): line for line in reversed(lines)}.values())[::-1]
    more = len(lines) - len(different[:_MOST])
    return different[:_MOST] + ([f"and {more} more like these"] if more else [])


def _hashes(campaign: Campaign) -> set[str]:
    return {hash_in(job.id) for job in campaign.jobs}


def _materials(campaign: Campaign) -> set[str]:
    """Names of the materials of all bodies of a campaign."""
    return {name for job in campaign.jobs for name in job.collision.material_names}


def _reaches_scenes(key: str, materials: set[str]) -> bool:
    """Whether a setting is a part of scenes of these materials; what a parameter set gives counts by its own key."""
    table, _, rest = key.partition(".")
    return rest.partition(".")[0] in materials if table == "materials" else key != "parameter_set"
