"""The campaign directory as its campaign.json describes it: axes, and the job of each cell."""

from pathlib import Path
from typing import Any, Self

from pydantic import BaseModel, ConfigDict, model_validator

from engine.errors import SceneError
from engine.scene.fields import read_table, validate

Scalar = float | int | str

NONE = "none"
"""What stands for a parameter that is not set, since netCDF knows no null."""


class Job(BaseModel):
    """One job: where it is, which cell it fills, and the parameters of its collision."""

    model_config = ConfigDict(frozen=True)

    id: str
    directory: str
    index: dict[str, Any]
    collision: dict[str, Any]

    @property
    def parameters(self) -> dict[str, Scalar]:
        """The parameters of the collision by dotted key: `viscosity.shear` for `viscosity: {shear}`."""
        return flatten(self.collision)


class Campaign(BaseModel):
    """A study and its jobs."""

    model_config = ConfigDict(frozen=True)

    name: str
    physics_version: int
    study: dict[str, Any] = {}
    dims: tuple[str, ...]
    coords: dict[str, tuple[Any, ...]]
    jobs: tuple[Job, ...]

    @model_validator(mode="after")
    def _jobs_lie_on_the_axes(self) -> Self:
        for dim in self.dims:
            if dim not in self.coords:
                raise ValueError(f"dimension '{dim}' has no coordinates")
            for job in self.jobs:
                if job.index.get(dim) not in self.coords[dim]:
                    raise ValueError(f"job '{job.id}' has no place on the axis '{dim}'")
        return self

    def cell(self, job: Job) -> tuple[int, ...]:
        """Position of a job along each dimension."""
        return tuple(self.coords[dim].index(job.index[dim]) for dim in self.dims)

    @property
    def description(self) -> str:
        """What the study says of itself."""
        return str(self.study.get("description", ""))

    @property
    def has_error_bars(self) -> bool:
        """Whether each cell of its results is made of several jobs."""
        return "resolution" in self.dims

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of each dimension."""
        return tuple(len(self.coords[dim]) for dim in self.dims)


def read_campaign(directory: Path) -> Campaign:
    """The campaign in a directory.

    Raises:
        SceneError: there is no campaign.json, or it does not describe a campaign.
    """
    path = directory / "campaign.json"
    if not path.is_file():
        raise SceneError(f"{directory}: holds no campaign.json; name the directory of a campaign")
    return validate(Campaign, read_table(path), str(path))


def flatten(table: dict[str, Any], prefix: str = "") -> dict[str, Scalar]:
    """Nested tables as one with dotted keys, values as netCDF attributes can hold them."""
    flat: dict[str, Scalar] = {}
    for key, value in table.items():
        if isinstance(value, dict):
            flat |= flatten(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = plain(value)
    return flat


def plain(value: Any) -> Scalar:
    """A number or text as it is, anything else in words."""
    if value is None:
        return NONE
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        return value
    return str(value).lower()
