"""Dotted keys: `viscosity.shear` for the table `viscosity = {shear = ...}`."""

from collections.abc import Iterable, Iterator
from copy import deepcopy
from functools import reduce
from typing import Any

from pydantic import BaseModel

from engine.scene.keys import ANY_NAME, has_names, models_in

LEADING = ("velocity", "angle")
"""Keys that come first wherever keys are listed."""


def ordered(keys: Iterable[str]) -> list[str]:
    """The keys with velocity and angle first, the others by name, so that their order in a file has no meaning."""
    return sorted(keys, key=lambda key: (LEADING.index(key) if key in LEADING else len(LEADING), key))


def flatten(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested tables as one table of dotted keys."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, dict) and value:
            flat |= flatten(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat


def nest(flat: dict[str, Any]) -> dict[str, Any]:
    """A table of dotted keys as nested tables; a later key wins over an earlier one."""
    table: dict[str, Any] = {}
    for key, value in deepcopy(flat).items():
        *parents, name = key.split(".")
        node = table
        for parent in parents:
            if not isinstance(node.get(parent), dict):
                node[parent] = {}
            node = node[parent]
        node[name] = value
    return table


def value_at(model: BaseModel, key: str) -> Any:
    """Return the value that a dotted key leads to, through models and tables by name."""
    return reduce(_inside, key.split("."), model)


def _inside(node: Any, part: str) -> Any:
    return node[part] if isinstance(node, dict) else getattr(node, part)


def scalar_keys(model: type[BaseModel], prefix: str = "") -> Iterator[str]:
    """List the dotted keys of all single values of an input model, for every kind of table that a key may contain.

    `NAME` stands for the names that a study gives: `materials.NAME.rho0`.
    """
    for name, field in model.model_fields.items():
        tables = models_in(field.annotation)
        inner = f"{prefix}{name}.{ANY_NAME}." if has_names(field) else f"{prefix}{name}."
        below = [key for table in tables for key in scalar_keys(table, inner)]
        yield from dict.fromkeys(below) if tables else [prefix + name]


def with_names_of(key: str, known: str) -> str:
    """Return a known key with the name that a given one has in place of `NAME`.

    Args:
        key: as given, `materials.ice.eos`.
        known: as from `scalar_keys`, `materials.NAME.eos.A`.
    """
    given, parts = key.split("."), known.split(".")
    at = parts.index(ANY_NAME) if ANY_NAME in parts else len(parts)
    has_name = given[:at] == parts[:at] and len(given) > at + 1
    return ".".join([*parts[:at], given[at], *parts[at + 1 :]] if has_name else parts)


def rest_of(key: str, known: str) -> str | None:
    """Return what follows a dotted key in a known one, empty where they are the same; None where they part.

    Args:
        key: as given, `materials.ice.eos`.
        known: as from `scalar_keys`, `materials.NAME.eos.A`.
    """
    given, parts = key.split("."), known.split(".")
    agree = len(given) <= len(parts) and all(part in (ANY_NAME, own) for own, part in zip(given, parts, strict=False))
    return ".".join(parts[len(given) :]) if agree else None
