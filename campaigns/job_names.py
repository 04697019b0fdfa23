"""Names of jobs: `v0200_a15` for 200 m/s and 15 degrees, then the hash of the scene."""

import hashlib
import re
from typing import Any

from pydantic import BaseModel

LONGEST = 60
"""Characters of an alias that a directory name keeps."""
HASH_LENGTH = 8
"""Characters of the hash of its scene that make the name of a job unique."""

_SHORT = {"velocity": ("v", 4), "angle": ("a", 2)}


def alias(values: dict[str, Any]) -> str:
    """The name of a job by the values in which it differs from the settings of its study."""
    return "_".join(_part(key, value) for key, value in values.items()) or "base"


def job_id(name: str, scene_hash: str) -> str:
    """The directory name of a job: its alias, then the start of the hash of its scene."""
    return f"{name[:LONGEST].rstrip('._-')}-{scene_hash[:HASH_LENGTH]}"


def hash_in(name: str) -> str:
    """Return the start of the hash of its scene, with which the id of a job ends."""
    return name[-HASH_LENGTH:]


def belongs_to(name: str, scene: bytes) -> bool:
    """Whether the content of scene.json is the scene whose hash ends the job id."""
    return hashlib.sha256(scene).hexdigest()[:HASH_LENGTH] == hash_in(name)


def _part(key: str, value: Any) -> str:
    letter, width = _SHORT.get(key, (key, 1))
    if isinstance(value, BaseModel | dict):
        return letter
    if isinstance(value, int | float) and not isinstance(value, bool):
        return letter + _number(value, width)
    return f"{letter}-{re.sub(r'[^a-z0-9.]+', '-', str(value).lower())}"


def _number(value: float, width: int) -> str:
    """All digits of a number, those before the point padded to `width`; 15 and 15.0 are the same."""
    whole, point, rest = repr(value).removesuffix(".0").replace("+", "").partition(".")
    return whole.zfill(width) + point + rest
