"""What a verification problem returns: measured values, each beside the one it should be."""

from dataclasses import dataclass
from math import inf
from typing import Protocol, Self

from engine.verification.harness import Harness


@dataclass(frozen=True)
class Check:
    """One comparison.

    Attributes:
        quantity: what is compared.
        unit: of both values; of the error too, unless the error is relative.
        measured: value of the run.
        expected: exact or published value.
        error: distance between them, in the problem's own measure.
        allowed: largest error that passes; infinite for what is only shown.
    """

    quantity: str
    unit: str
    measured: float
    expected: float
    error: float
    allowed: float

    @classmethod
    def absolute(cls, quantity: str, unit: str, measured: float, expected: float, allowed: float) -> Self:
        """Return the comparison by |measured - expected|."""
        return cls(quantity, unit, measured, expected, abs(measured - expected), allowed)

    @classmethod
    def relative(
        cls, quantity: str, unit: str, measured: float, expected: float, allowed: float, scale: float = 0.0
    ) -> Self:
        """Return the comparison by |measured - expected|/|scale|; the scale is the expected value unless given."""
        return cls(quantity, unit, measured, expected, abs(measured - expected) / abs(scale or expected), allowed)

    @property
    def passed(self) -> bool:
        """Whether the error is allowed; one that is not a number never is, unless it is only shown."""
        return self.allowed == inf or self.error <= self.allowed


class Problem(Protocol):
    """A scene with a known answer."""

    @property
    def name(self) -> str:
        """Name on the command line."""

    def checks(self, harness: Harness) -> list[Check]:
        """Run the scene in a harness and compare it with the answer; Taichi must have been started.

        Raises:
            RunFault: a particle left the range in which the equations hold.
        """
