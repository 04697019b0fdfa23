"""Set-ups of one collision as tables laid under the keys of a study (engine/physics.md, sections 4-5)."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from engine.scene.tables import overlay

DEFAULT = "sugiura2018"
"""Set of a collision that names none."""

PARAMETER_SETS: dict[str, dict[str, Any]] = {
    "sugiura2018": {},  # its constants are the shipped basalt and the defaults of FractureRules
    "talk": {
        "materials": {"basalt": {"friction": 0.945}},  # Klar's cone of 40 deg
        "fracture": {"flaws": "2NlnN", "strain": "young", "growth_speed": 0.5, "per_flaw": False},
    },
    # phi = 40 deg in all directions, as soil mechanics has it for broken rock
    "rubble": {"materials": {"basalt": {"friction": 0.945, "friction_law": "mohr-coulomb"}}},
}
"""Keys of engine.scene.collision.Collision in which the set-ups differ from its defaults, by the name of the set."""


def over_set(name: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys of a collision laid over those of a parameter set.

    The constants that a set has for a shipped material lie under every table that starts from this material, also one
    under another name. A `Material` of Python is complete and stays as it is; of the other models only those values
    count that were given.

    Args:
        name: of the set; an unknown one has no keys.
        given: keys of a collision and their values.
    """
    published = dict(PARAMETER_SETS.get(name, {}))
    materials = published.pop("materials", {})
    laid = overlay(published, {key: _given_part(value) if key in published else value for key, value in given.items()})
    tables = given.get("materials", {})
    if isinstance(tables, Mapping):
        laid["materials"] = materials | {own: _over_start(materials, own, table) for own, table in tables.items()}
    return laid


def _given_part(value: Any) -> Any:
    return value.model_dump(exclude_unset=True) if isinstance(value, BaseModel) else value


def _over_start(materials: Mapping[str, Any], own: str, table: Any) -> Any:
    """The table of a material over the constants that the set has for the one it starts from."""
    if not isinstance(table, Mapping):
        return table
    start = table.get("name", own)
    return overlay(materials.get(start, {}) if isinstance(start, str) else {}, table)
