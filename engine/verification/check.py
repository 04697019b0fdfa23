"""What a verification problem reports: one measured number beside the one it should be."""

from dataclasses import dataclass
from math import inf
from typing import Protocol


@dataclass(frozen=True)
class Check:
    """One comparison.

    Attributes:
        quantity: what is compared.
        unit: unit of both values; of the error too, unless it is a share.
        measured, expected: value of the run, and exact or published value.
        error: distance between them, in the problem's own measure.
        allowed: largest error that passes; infinite for what is reported only.
    """

    quantity: str
    unit: str
    measured: float
    expected: float
    error: float
    allowed: float

    @property
    def passed(self) -> bool:
        """Whether the error is allowed; one that is not a number never is, unless it is only reported."""
        return self.allowed == inf or self.error <= self.allowed


class Problem(Protocol):
    """A scene with a known answer; Taichi must have been started before it runs."""

    @property
    def name(self) -> str:
        """Name on the command line."""

    def checks(self) -> list[Check]:
        """Run the scene and compare it with the answer."""


def difference(quantity: str, unit: str, measured: float, expected: float, allowed: float) -> Check:
    """A comparison by absolute difference."""
    return Check(quantity, unit, measured, expected, abs(measured - expected), allowed)


def share(quantity: str, unit: str, measured: float, expected: float, allowed: float, of: float = 0.0) -> Check:
    """A comparison by difference as a share `of` a scale, by default of the expected value."""
    return Check(quantity, unit, measured, expected, abs(measured - expected) / abs(of or expected), allowed)
