"""Options of the device, without Taichi: the architecture and the precision of all numbers.

A process has one precision, chosen before the device modules are imported.
"""

import os
from enum import StrEnum
from typing import Literal, cast, get_args

from engine.errors import SceneError


class Arch(StrEnum):
    """Devices the engine runs on."""

    CPU = "cpu"
    CUDA = "cuda"
    VULKAN = "vulkan"
    GPU = "gpu"


CUDA_DEVICES, VULKAN_DEVICE = "CUDA_VISIBLE_DEVICES", "TI_VISIBLE_DEVICE"
"""Environment variables by which a process sees some of several GPUs."""

Precision = Literal["f64", "f32"]
"""Names of the precisions: double and single."""

VARIABLE = "ENGINE_PRECISION"
"""Environment variable of the precision, for this process and those it starts."""


def usable_cores() -> int:
    """Return the number of CPU cores that this process may use: those of its affinity mask where the system has one.

    A batch system or `taskset` gives a process some of the cores of a machine.
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def choose(precision: Precision) -> None:
    """Set the precision of the device modules, if they are not imported yet."""
    os.environ[VARIABLE] = precision


def chosen() -> Precision:
    """Return the precision that the environment asks for, `f64` if none.

    Raises:
        SceneError: the environment names another one.
    """
    given = os.environ.get(VARIABLE, "f64")
    if given in get_args(Precision):
        return cast(Precision, given)
    raise SceneError(f"{VARIABLE}: '{given}' is no precision; allowed: {', '.join(get_args(Precision))}")
