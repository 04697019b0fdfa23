"""A campaign: the jobs of a study, as campaign.json describes them, written by this version or another."""

from pathlib import Path
from typing import Generic, Self, TypeVar

from pydantic import BaseModel, ConfigDict, JsonValue, model_validator

from campaigns.study import Study
from engine.errors import SceneError
from engine.scene.collision import Collision
from engine.scene.fields import read_table, validate

Scalar = bool | int | float | str | None
Table = dict[str, JsonValue]
Content = TypeVar("Content")
Settings = TypeVar("Settings")

FILE = "campaign.json"
"""Name of the description in the directory of a campaign."""


class JobEntry(BaseModel, Generic[Settings]):
    """One collision of a campaign.

    Attributes:
        id: alias and hash, the name of its directory.
        directory: job directory, relative to the campaign's.
        index: value of the job on each dimension.
        collision: all settings of the collision.
    """

    model_config = ConfigDict(frozen=True)

    id: str
    directory: str
    index: dict[str, Scalar]
    collision: Settings

    def called(self, name: str) -> Self:
        """The same job under the id `name`."""
        return self.model_copy(update={"id": name, "directory": f"jobs/{name}"})


class CampaignFile(BaseModel, Generic[Content, Settings]):
    """Content of campaign.json: all jobs of a study.

    Attributes:
        name: name of the study.
        physics_version: the engine's, when the campaign was started.
        study: content of the study file.
        dims: `case`, where the study has cases, its axes, and, where it has error bars, `resolution` and `seed`.
        coords: values along each dimension.
        jobs: all jobs, in the order in which they are run.
    """

    model_config = ConfigDict(frozen=True)

    name: str
    physics_version: int
    study: Content
    dims: tuple[str, ...]
    coords: dict[str, tuple[Scalar, ...]]
    jobs: tuple[JobEntry[Settings], ...]

    @model_validator(mode="after")
    def _jobs_lie_on_the_axes(self) -> Self:
        for dim in self.dims:
            if dim not in self.coords:
                raise ValueError(f"dimension '{dim}' has no coordinates")
            for job in self.jobs:
                if dim not in job.index or job.index[dim] not in self.coords[dim]:
                    raise ValueError(f"job '{job.id}' has no place on the axis '{dim}'")
        return self

    def position(self, job: JobEntry[Settings]) -> tuple[int, ...]:
        """Index of a job along each dimension."""
        return tuple(self.coords[dim].index(job.index[dim]) for dim in self.dims)

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of each dimension."""
        return tuple(len(self.coords[dim]) for dim in self.dims)

    @property
    def has_error_bars(self) -> bool:
        """Whether each point of the study is made of several jobs."""
        return "resolution" in self.dims

    def content(self) -> Table:
        """The campaign as plain JSON values."""
        return self.model_dump(mode="json")


Job = JobEntry[Collision]
Campaign = CampaignFile[Study, Collision]
"""A campaign whose study and collisions this version knows: it can be run."""
KeptJob = JobEntry[Table]
KeptCampaign = CampaignFile[Table, Table]
"""A campaign of any version: study and collisions are as that version wrote them."""

Kept = TypeVar("Kept", Campaign, KeptCampaign)


def read_campaign(directory: Path, kind: type[Kept]) -> Kept:
    """Read the campaign in a directory.

    Args:
        directory: of the campaign.
        kind: `Campaign` to run it, `KeptCampaign` to read what any version computed.

    Raises:
        SceneError: there is no campaign.json, or it does not describe a campaign of this kind.
    """
    path = directory / FILE
    if not path.is_file():
        raise SceneError(
            f"{directory}: contains no {FILE}; name the directory of a campaign, or start one with: "
            "make campaign STUDY=..."
        )
    return validate(kind, read_table(path), str(path))
