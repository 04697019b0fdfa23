"""Strict, frozen input models and errors that name the file, the key and the way out."""

import difflib
import hashlib
import json
import tomllib
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from engine.errors import SceneError

# -0.0 + 0.0 is 0.0: one text for one meaning
Finite = Annotated[float, Field(allow_inf_nan=False), AfterValidator(lambda value: value + 0.0)]
Positive = Annotated[Finite, Field(gt=0.0)]
NonNegative = Annotated[Finite, Field(ge=0.0)]
Vector = tuple[Finite, Finite, Finite]
Model = TypeVar("Model", bound=BaseModel)


class Frozen(BaseModel):
    """Base of every input model: immutable, and unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=True)

    def canonical(self) -> str:
        """The values as canonical JSON: one text for one meaning, so that 100 and 100.0 agree."""
        return json.dumps(self.model_dump(mode="json"), sort_keys=True, indent=1)

    def hash(self) -> str:
        """SHA-256 of the canonical JSON, as a hex string."""
        return hashlib.sha256(self.canonical().encode()).hexdigest()


def read_table(path: Path) -> dict[str, Any]:
    """The content of a TOML or JSON file.

    Raises:
        SceneError: the file is missing, unreadable or malformed.
    """
    try:
        text = path.read_text(encoding="utf-8")
        table = json.loads(text) if path.suffix == ".json" else tomllib.loads(text)
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: cannot be read: {error}") from error
    except (tomllib.TOMLDecodeError, json.JSONDecodeError) as error:
        raise SceneError(f"{path}: not valid {path.suffix.lstrip('.').upper() or 'TOML'}: {error}") from error
    if not isinstance(table, dict):
        raise SceneError(f"{path}: expected a table of keys at the top level, found {type(table).__name__}")
    return table


def validate(model: type[Model], table: dict[str, Any], source: str) -> Model:
    """`table` as a `model`.

    Args:
        model: the input model.
        table: plain keys and values.
        source: the file (or other origin) that errors name.

    Raises:
        SceneError: one line per wrong key: where, what was given, what is allowed.
    """
    try:
        return model.model_validate(table)
    except ValidationError as error:
        lines = [f"{source}: {_explain(model, issue)}" for issue in error.errors()]
        raise SceneError("\n".join(lines)) from error


def _explain(model: type[BaseModel], issue: Any) -> str:
    # a tag in angle brackets tells which model was tried; it is no part of the input
    location = [str(part) for part in issue["loc"] if not str(part).startswith("<")]
    key = ".".join(location) or "input"
    if issue["type"] == "extra_forbidden":
        return f"unknown key '{key}'{suggestion(location[-1], _known_keys(model, issue['loc'][:-1]))}"
    if issue["type"] == "missing":
        return f"missing key '{key}'"
    message = issue["msg"].removeprefix("Value error, ")
    given = "" if isinstance(issue["input"], dict) else f" (given {issue['input']!r})"
    return f"'{key}': {message}{given}"


def suggestion(name: str, known: list[str]) -> str:
    """The nearest known name, or all of them, as the tail of an error message."""
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    return f": did you mean '{near[0]}'?" if near else f"; known keys: {', '.join(known)}"


def _known_keys(model: type[BaseModel], location: tuple[Any, ...]) -> list[str]:
    """Field names of the model that `location` leads to from `model`."""
    for part in location:
        if isinstance(part, str) and part in model.model_fields:
            model = _nested_model(model.model_fields[part].annotation) or model
    return list(model.model_fields)


def _nested_model(annotation: Any) -> type[BaseModel] | None:
    """The input model inside `Model`, `Model | None`, or `tuple[Model, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    inner = (_nested_model(argument) for argument in getattr(annotation, "__args__", ()))
    return next((model for model in inner if model), None)
