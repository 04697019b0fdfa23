"""Which setting each case of a campaign varies, against the case named base."""

from dataclasses import dataclass

from analysis.results.variables import NONE, Attribute, parameters
from campaigns.campaign import KeptCampaign
from engine.errors import SceneError

BASE = "base"
"""Name of the case that all others are compared with."""

RESOLUTION = (NONE, "particles")
"""Settings of the cases that differ in resolution alone."""

SEVERAL = "several"
"""Setting of a case that differs from the base in more than one, or leaves out a part with all its settings."""


@dataclass(frozen=True)
class VariedCase:
    """One case of a campaign.

    Attributes:
        setting: dotted key of the one setting in which it differs from the base; `none` for the base, else `several`.
        value: of that setting, `none` for the base.
        particles: number of particles of the target.
    """

    setting: str
    value: Attribute
    particles: int


def cases(campaign: KeptCampaign) -> dict[str, VariedCase]:
    """Return all cases of a campaign by name.

    Raises:
        SceneError: the campaign has other dimensions than case and seed, or no case named base.
    """
    if campaign.dims != ("case", "seed"):
        raise SceneError(
            f"campaign {campaign.name}: has the dimensions {', '.join(campaign.dims)}; "
            "accuracy needs [[cases]] and the axis seed, as the study accuracy has them"
        )
    if BASE not in campaign.coords["case"]:
        raise SceneError(f"campaign {campaign.name}: has no case '{BASE}'; give the one to compare with that name")
    tables = {str(job.index["case"]): parameters(job) for job in campaign.jobs}
    return {name: _case(table, tables[BASE]) for name, table in tables.items()}


def _case(table: dict[str, Attribute], base: dict[str, Attribute]) -> VariedCase:
    keys = [key for key in table | base if key != "seed" and _value(table, key) != _value(base, key)]
    is_one = len(keys) == 1 and table.get(keys[0], NONE) != NONE
    setting = keys[0] if is_one else SEVERAL if keys else NONE
    return VariedCase(setting, table.get(setting, NONE), int(table["particles"]))


def _value(table: dict[str, Attribute], key: str) -> Attribute:
    """Value of a setting; one that is not set counts as 0, as no viscosity is a viscosity of 0."""
    value = table.get(key, NONE)
    return 0.0 if value == NONE else value
