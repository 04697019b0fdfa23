"""Tables of keys laid over one another."""

from collections.abc import Mapping
from typing import Any


def overlay(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys of `base` with those of `changes` in their place, table by table at any depth.

    A table whose `form` differs from the one below replaces it: constants of two forms have nothing in common.
    """
    merged = dict(base)
    for key, value in changes.items():
        below = merged.get(key)
        merges = isinstance(below, Mapping) and isinstance(value, Mapping) and _is_same_form(below, value)
        merged[key] = overlay(below, value) if merges else value  # type: ignore[arg-type]
    return merged


def _is_same_form(below: Mapping[str, Any], above: Mapping[str, Any]) -> bool:
    return "form" not in above or above["form"] == below.get("form")
