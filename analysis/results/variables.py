"""The variables of results.nc beside the outcomes: parameters of the jobs by dotted key, and texts."""

from pydantic import JsonValue

from campaigns.campaign import KeptJob
from campaigns.dotted_keys import flatten
from engine.job.directory import JobState
from engine.quantities import Quantity
from engine.scene.collision import Collision
from engine.scene.keys import meaning_of, unit_of

Attribute = float | int | str
"""What netCDF stores of a parameter."""

NONE = "none"
"""What stands for a parameter that is not set, since netCDF knows no null."""


def parameters(job: KeptJob) -> dict[str, Attribute]:
    """Parameters of the collision of a job by dotted key: `viscosity.shear` for `viscosity: {shear}`."""
    return {key: plain(value) for key, value in flatten(job.collision).items()}


def plain(value: JsonValue) -> Attribute:
    """A number or text as it is, `none` for null, anything else as text."""
    if value is None:
        return NONE
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        return value
    return str(value).lower()


_STATES = ", ".join(state for state in JobState if state != JobState.MISSING)

TEXTS = {
    "state": Quantity("state of the job", "", f"{_STATES}, or {JobState.MISSING} without a job"),
    "reason": Quantity("why the job has no outcome", ""),
    "job": Quantity("identifier of the job", ""),
}
"""Texts of one job."""

PARAMETERS = {"case": Quantity("name of the case", "")}
"""Coordinates of results.nc that are no keys of a collision; others keep their own name and no unit."""


def parameter(key: str) -> Quantity:
    """Return what a coordinate or attribute of results.nc is: the meaning and unit of the dotted key of a collision."""
    meaning = meaning_of(Collision, key)
    if meaning is None:
        return PARAMETERS.get(key, Quantity(key.replace("_", " "), ""))
    return Quantity(meaning, unit_of(Collision, key) or "")
