"""Dotted keys of input models, `materials.basalt.eos.A`: what they mean, in which unit, and what old ones are now."""

from collections.abc import Iterator
from typing import Any, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

ANY_NAME = "NAME"
"""Stands for the names that a study gives itself in a key: `materials.NAME.rho0`."""


def models_in(annotation: Any) -> list[type[BaseModel]]:
    """Return the input models inside `Model`, `Model | None`, `tuple[Model, ...]` or `dict[str, Model]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for argument in getattr(annotation, "__args__", ()) for model in models_in(argument)]


def has_names(field: FieldInfo) -> bool:
    """Return whether a field is a table of tables under names of the user's choice."""
    return get_origin(field.annotation) is dict and bool(models_in(field.annotation))


def meaning_of(model: type[BaseModel], key: str) -> str | None:
    """Return the meaning of a dotted key, None if there is no such key."""
    return next((field.description for field in _fields_at(model, key)), None)


def unit_of(model: type[BaseModel], key: str) -> str | None:
    """Return the unit of a dotted key as CF writes it: `1` for a pure number, empty for texts; None for no such key."""
    field = next(_fields_at(model, key), None)
    extra = field.json_schema_extra if field else None
    return str(extra.get("unit", "")) if isinstance(extra, dict) else None


def current_key(model: type[BaseModel], key: str) -> str | None:
    """Return the name that a dotted key has now, None if no part of it was renamed.

    Input models list their old keys as `renamed_keys`, each with the dotted key that replaces it.
    """
    head, _, rest = key.partition(".")
    renamed = getattr(model, "renamed_keys", {}).get(head)
    if renamed:
        moved = f"{renamed}.{rest}" if rest else renamed
        return current_key(model, moved) or moved
    for prefix, table, inner in _steps(model, head, rest):
        if found := current_key(table, inner):
            return f"{prefix}{found}"
    return None


def _fields_at(model: type[BaseModel], key: str) -> Iterator[FieldInfo]:
    """Find the fields that a dotted key leads to, one for each kind of table that has it."""
    head, _, rest = key.partition(".")
    if not rest and head in model.model_fields:
        yield model.model_fields[head]
    for _, table, inner in _steps(model, head, rest):
        yield from _fields_at(table, inner)


def _steps(model: type[BaseModel], head: str, rest: str) -> Iterator[tuple[str, type[BaseModel], str]]:
    """Go one table down: the part of the key that leads there, its model, and what is left of the key."""
    field = model.model_fields.get(head)
    if field is None or not rest:
        return
    prefix = f"{head}."
    if get_origin(field.annotation) in (tuple, dict):
        name, _, rest = rest.partition(".")
        prefix = f"{head}.{name}."
    for table in models_in(field.annotation):
        yield prefix, table, rest
