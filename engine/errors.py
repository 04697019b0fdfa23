"""Errors that a user can act on, and exit codes."""

import math
from dataclasses import dataclass
from enum import IntEnum


class ExitCode(IntEnum):
    """Exit codes of `python -m engine`."""

    DONE = 0
    FAILED = 1
    BAD_INPUT = 2
    BUSY = 3
    INTERRUPTED = 130


SMALLER_STEPS = "try a smaller numerics.cfl"
"""Advice where an unstable time step may be the cause."""


class SceneError(ValueError):
    """The input cannot be used; the message names file and key, what was given, and what is allowed."""


class JobError(RuntimeError):
    """The job directory cannot be run: of another physics version, or damaged."""


class JobBusyError(JobError):
    """Another process runs the job."""


class UnavailableError(JobError):
    """The system refuses to read a file of a job now; its content may be sound."""


def in_words(error: OSError, path: object = "") -> str:
    """Return one line that names the file and what is wrong with it.

    Args:
        error: raised by the operating system.
        path: named if the error names no file.
    """
    where = error.filename or path
    return f"{where}: {error.strerror or error}" if where else f"{error.strerror or error}"


MEMORY_IS_FULL = (
    "the memory of the device is full: run fewer jobs on it at once, or a scene with fewer particles or "
    'numerics.precision = "f32"; python -m engine explain SCENE shows what a scene takes'
)
"""What a user reads when a device has no room for a scene."""


def is_out_of_memory(error: Exception) -> bool:
    """Return whether an error of Taichi means that the device has no memory left."""
    words = ("failed to allocate", "out of memory", "out_of_memory")
    return isinstance(error, RuntimeError) and any(word in str(error).lower() for word in words)


class RunFault(RuntimeError):
    """A state is outside the range in which the equations are valid."""


@dataclass(frozen=True)
class Fault:
    """Why the guard stopped a simulation.

    Attributes:
        quantity: what is out of bounds, with its unit.
        value: its value; `None` if it is not finite.
        allowed: its bounds, in words.
        time: simulated time [s].
        particle: number of the particle in the scene; `None` for a quantity of the whole run.
        advice: what to try.
    """

    quantity: str
    value: float | None
    allowed: str
    time: float
    particle: int | None
    advice: str

    def __str__(self) -> str:
        whose = "" if self.particle is None else f" of particle {self.particle}"
        value = "not finite" if self.value is None else f"{self.value:.6g}"
        return f"{self.quantity}{whose} is {value} at t = {self.time:.6g} s, allowed: {self.allowed}; {self.advice}"


class GuardFault(RunFault):
    """A guard stopped the run; `fault` says why.

    Args:
        fault: the reason.
    """

    def __init__(self, fault: Fault) -> None:
        super().__init__(str(fault))
        self.fault = fault


def stop(
    quantity: str,
    value: float,
    allowed: str,
    time: float,
    particle: int | None = None,
    *,
    advice: str,
) -> GuardFault:
    """Return the error that stops a run; arguments as the attributes of `Fault`, but `value` may be not finite."""
    return GuardFault(Fault(quantity, value if math.isfinite(value) else None, allowed, time, particle, advice))
