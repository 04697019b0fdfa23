"""Strict, frozen input models, and the kinds of numbers in them."""

import hashlib
import json
import tomllib
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from engine.errors import SceneError
from engine.scene.input_errors import explain

DEEPEST = 20
"""Tables and lists inside each other that an input file may contain."""


def _numeral(value: Any) -> Any:
    if isinstance(value, bool | str):
        raise ValueError(f"Input should be a number, not {'text' if isinstance(value, str) else 'true or false'}")
    return value


Number = Annotated[float, BeforeValidator(_numeral)]
Whole = Annotated[int, BeforeValidator(_numeral)]
# -0.0 + 0.0 is 0.0: one text for one meaning
Finite = Annotated[Number, Field(allow_inf_nan=False), AfterValidator(lambda value: value + 0.0)]
Positive = Annotated[Finite, Field(gt=0.0)]
NonNegative = Annotated[Finite, Field(ge=0.0)]
Vector = tuple[Finite, Finite, Finite]
Model = TypeVar("Model", bound=BaseModel)
Kind = TypeVar("Kind")
# TOML has no null
OrOff = Annotated[Kind | None, BeforeValidator(lambda value: None if value is False else value)]
"""A part that `false` leaves out."""


def key(meaning: str, unit: str = "") -> Any:
    """Describe a key of an input model.

    Args:
        meaning: what it is, as the long name in data sets.
        unit: as CF writes it, `1` for a pure number; empty for texts, switches and tables.
    """
    return Field(description=meaning, json_schema_extra={"unit": unit})


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
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{path}: not valid {path.suffix.lstrip('.').upper() or 'TOML'}: {error}") from error
    if not isinstance(table, dict):
        raise SceneError(f"{path}: expected a table of keys at the top level, found {type(table).__name__}")
    if _is_deep(table):
        raise SceneError(f"{path}: more than {DEEPEST} tables or lists inside each other; no key is so deep")
    return table


def _is_deep(content: Any) -> bool:
    """Whether tables and lists lie inside each other beyond all use."""
    level = [content]
    for _ in range(DEEPEST):
        inner = (part.values() if isinstance(part, dict) else part for part in level)
        level = [value for values in inner for value in values if isinstance(value, dict | list)]
    return bool(level)


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
        raise SceneError("\n".join(f"{source}: {line}" for line in explain(model, table, error))) from error
