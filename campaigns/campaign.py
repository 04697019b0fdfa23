"""A campaign: the jobs of a study, as campaign.json holds them."""

from typing import Any

from campaigns.study import Study
from engine.scene.collision import Collision
from engine.scene.fields import Frozen

Scalar = bool | int | float | str | None


class Job(Frozen):
    """One collision of a campaign.

    id: alias and hash, the name of its directory.
    directory: job directory, relative to the campaign's.
    index: where the job lies on each dimension.
    collision: all its settings.
    """

    id: str
    directory: str
    index: dict[str, Scalar]
    collision: Collision

    def called(self, name: str) -> "Job":
        """The same job under the id `name`."""
        return self.model_copy(update={"id": name, "directory": f"jobs/{name}"})


class Campaign(Frozen):
    """All jobs of a study.

    name: name of the study.
    physics_version: the engine's, when the campaign was started.
    dims: `case`, where the study has cases, its axes, and, where it has error bars, `resolution` and `seed`.
    coords: values along each dimension.
    """

    name: str
    physics_version: int
    study: Study
    dims: tuple[str, ...]
    coords: dict[str, tuple[Scalar, ...]]
    jobs: tuple[Job, ...]

    def content(self) -> dict[str, Any]:
        """The campaign as plain JSON values."""
        return self.model_dump(mode="json")
