"""What the engine tells its user when it cannot go on."""

import math
from dataclasses import dataclass
from enum import IntEnum


class ExitCode(IntEnum):
    """How a process of the engine ended."""

    DONE = 0
    FAILED = 1
    BAD_INPUT = 2
    BUSY = 3
    INTERRUPTED = 130


SMALLER_STEPS = "try a smaller numerics.cfl"
"""Advice where an unstable time step may be the cause."""


class SceneError(ValueError):
    """The input cannot be used: says which file and key, what was given, and what is allowed."""


class JobError(RuntimeError):
    """The job directory cannot be run: of another physics version, or damaged."""


class JobBusyError(JobError):
    """Another process runs the job."""


def in_words(error: OSError, place: object = "") -> str:
    """The file and what is wrong with it, in one line; `place` stands in where the error names none."""
    where = error.filename or place
    return f"{where}: {error.strerror or error}" if where else f"{error.strerror or error}"


class RunFault(RuntimeError):
    """A simulation, or what it left, holds values outside the range in which its equations hold."""


@dataclass(frozen=True)
class Fault:
    """Why a running simulation was stopped.

    Attributes:
        quantity: what left its range, with its unit.
        value: what it was; `None` when it was not finite.
        allowed: its range, in words.
        time: simulated time [s] at which it was found.
        particle: index of the particle; `None` for a quantity of the whole run.
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
    """What to raise to stop a run; arguments as the attributes of `Fault`, except that `value` may not be finite."""
    return GuardFault(Fault(quantity, value if math.isfinite(value) else None, allowed, time, particle, advice))
