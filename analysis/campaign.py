"""The parameters of jobs as netCDF can store them: numbers and texts by dotted key."""

from pydantic import JsonValue

from campaigns.campaign import KeptJob
from campaigns.dotted_keys import flatten

Scalar = float | int | str

NONE = "none"
"""What stands for a parameter that is not set, since netCDF knows no null."""


def parameters(job: KeptJob) -> dict[str, Scalar]:
    """Parameters of the collision of a job by dotted key: `viscosity.shear` for `viscosity: {shear}`."""
    return {key: plain(value) for key, value in flatten(job.collision).items()}


def plain(value: JsonValue) -> Scalar:
    """A number or text as it is, `none` for null, anything else as text."""
    if value is None:
        return NONE
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        return value
    return str(value).lower()
