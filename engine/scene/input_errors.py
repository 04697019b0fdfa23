"""What is wrong with an input, in lines that name the key, what was given and what is allowed."""

import difflib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from engine.scene.keys import ANY_NAME, current_key, has_names, models_in

Location = tuple[int | str, ...]

PLAIN = {
    "model_type": "Input should be a table of keys",
    "dict_type": "Input should be a table of keys",
    "tuple_type": "Input should be a list",
    "int_parsing_size": "Input is too large",
}
"""Texts for issues that pydantic explains in terms of Python."""


@dataclass(frozen=True)
class KeysOfModel:
    """Marks a plain table whose keys are those of a model, checked later."""

    model: type[BaseModel]


def did_you_mean(name: str, known: Sequence[str], what: str = "keys", below: Sequence[str] = ()) -> str:
    """The known name that was meant, or all of them, as the tail of an error message.

    Args:
        name: what was given.
        known: what it could have been.
        what: what these are.
        below: dotted keys of the tables among them, one of which may end in `name`.
    """
    same = [key for key in (*known, *below) if key.rpartition(".")[2] == name]
    near = sorted(same, key=len) or difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    return f": did you mean '{near[0]}'?" if near else f"; known {what}: {', '.join(known)}"


def explain(model: type[BaseModel], table: dict[str, Any], error: ValidationError) -> Iterator[str]:
    """Return the lines for all wrong keys of a table; for a table inside it only those of the wrong keys there."""
    found: dict[Location, list[Any]] = {}
    for issue in error.errors():
        found.setdefault(_location(table, issue), []).append(issue)
    old = {location[:-1] for location, issues in found.items() if _new_names(model, location, issues[0])}
    for location, issues in found.items():
        has_wrong_keys = any(other[: len(location)] == location != other for other in found)
        may_be_renamed = issues[0]["type"] == "missing" and location[:-1] and location[:-1] in old
        if not has_wrong_keys and not may_be_renamed:
            yield from _lines(model, location, issues)


def _location(table: Any, issue: Any) -> Location:
    """The keys that lead to an issue: its location without the names of the models that were tried."""
    location: Location = ()
    for part in issue["loc"]:
        keys = range(len(table)) if isinstance(table, list | tuple) else table
        if isinstance(keys, dict | range) and part in keys:
            location, table = (*location, part), table[part]
    return (*location, issue["loc"][-1]) if issue["type"] == "missing" else location


def _lines(model: type[BaseModel], location: Location, issues: list[Any]) -> Iterator[str]:
    key, first = _dotted(location), issues[0]
    if renamed := _new_names(model, location, first):
        yield from (f"'{old}' is now '{new}'" for old, new in renamed.items())
    elif first["type"] == "extra_forbidden":
        nearby = _model_at(model, first["loc"][:-1])
        hint = did_you_mean(str(location[-1]), list(nearby.model_fields), below=_keys_below(nearby))
        yield f"unknown key '{key}'{hint}"
    elif first["type"] == "missing":
        yield f"missing key '{key}'"
    else:
        given = "" if isinstance(first["input"], dict) else f" (given {first['input']!r})"
        yield (f"'{key}': " if key else "") + _allowed(issues) + given


def _new_names(model: type[BaseModel], location: Location, issue: Any) -> dict[str, str]:
    """What an unknown key is now; where it is a table whose own keys were renamed too, what each of these is now."""
    if issue["type"] != "extra_forbidden":
        return {}
    key = _dotted(location)
    renamed = {old: current_key(model, old) for old in map(_dotted, _ends(location, issue["input"]))}
    names = {old: new for old, new in renamed.items() if new}
    whole = current_key(model, key)
    return {key: whole} if whole and all(new == whole + old[len(key) :] for old, new in names.items()) else names


def _ends(location: Location, value: Any) -> Iterator[Location]:
    """The keys of all single values of a table; of a value, its own."""
    if not isinstance(value, dict) or not value:
        yield location
        return
    for key, inner in value.items():
        yield from _ends((*location, key), inner)


def _dotted(location: Location) -> str:
    return ".".join(str(part) for part in location)


def _allowed(issues: list[Any]) -> str:
    """What a value may be: one of several kinds, when it was tried as each of them."""
    first, *others = (PLAIN.get(issue["type"], issue["msg"]).removeprefix("Value error, ") for issue in issues)
    return " or ".join([first, *(other.removeprefix("Input should be ") for other in others)])


def _model_at(model: type[BaseModel], location: Location) -> type[BaseModel]:
    """The input model that `location` leads to from `model`."""
    choices = [model]
    for part in location:
        inside = [inner for choice in choices for inner in _models_of(choice, part)]
        choices = [choice for choice in choices if _tag(choice) == part] or inside or choices
    return choices[0]


def _tag(model: type[BaseModel]) -> str:
    """What stands for a model in the location of an issue where several were possible: its form, or its name."""
    return str(model.model_fields["form"].default) if "form" in model.model_fields else model.__name__


def _models_of(model: type[BaseModel], name: int | str) -> list[type[BaseModel]]:
    """The input models that a field may contain."""
    field = model.model_fields.get(str(name))
    return models_in(field.annotation) if field else []


def _keys_below(model: type[BaseModel]) -> list[str]:
    """Dotted keys of the tables that `model` contains, at any depth."""
    return [
        f"{name}.{ANY_NAME}.{key}" if has_names(field) else f"{name}.{key}"
        for name, field in model.model_fields.items()
        for table in _tables_in(field)
        for key in (*table.model_fields, *_keys_below(table))
    ]


def _tables_in(field: FieldInfo) -> list[type[BaseModel]]:
    """The input models that a field may contain as a table, not those in lists."""
    marked = [mark.model for mark in field.metadata if isinstance(mark, KeysOfModel)]
    return marked if get_origin(field.annotation) is tuple else marked + models_in(field.annotation)
