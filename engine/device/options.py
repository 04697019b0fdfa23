"""What a user chooses of the device, without Taichi: the architecture, and the precision of all numbers.

Precision is one per process, chosen before the device modules are imported.
"""

import os
from enum import StrEnum
from typing import Literal, cast, get_args

from engine.errors import SceneError


class Arch(StrEnum):
    """Devices the engine runs on."""

    CPU = "cpu"
    CUDA = "cuda"


Precision = Literal["f64", "f32"]

VARIABLE = "ENGINE_PRECISION"
"""Environment variable that holds the choice, for this process and those it starts."""


def choose(precision: Precision) -> None:
    """Let device modules that are imported from now on use a precision."""
    os.environ[VARIABLE] = precision


def chosen() -> Precision:
    """The precision to build with.

    Raises:
        SceneError: there is no such precision.
    """
    given = os.environ.get(VARIABLE, "f64")
    if given in get_args(Precision):
        return cast(Precision, given)
    raise SceneError(f"{VARIABLE}: '{given}' is no precision; allowed: {', '.join(get_args(Precision))}")
