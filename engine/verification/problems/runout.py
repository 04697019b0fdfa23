"""Run-out of collapsing columns of rubble in a plane (engine/physics.md, sections 4 and 11)."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from engine.verification.check import Check
from engine.verification.harness import Harness
from engine.verification.problems.cliff import Cliff

EXPERIMENTS: dict[str, Callable[[float], float]] = {
    "Lajeunesse 2005": lambda a: 1.8 * a if a < 3.0 else 2.3 * a ** (2.0 / 3.0),
    "Lube 2005": lambda a: 1.2 * a if a < 2.3 else 1.9 * a ** (2.0 / 3.0),
}
"""Distance the front runs [L0] over the aspect ratio a = H0/L0: Lajeunesse et al. 2005, Lube et al. 2005."""


@dataclass(frozen=True)
class Runout:
    """Columns of two heights that collapse as the cliff does.

    Shown only: the two experiments disagree by a factor of 1.2 to 1.5 with each other.

    Attributes:
        aspects: initial heights over the initial width.
        cells: cells along the initial width.
    """

    name = "runout"
    aspects: tuple[float, ...] = (1.0, 5.0)
    cells: int = 10

    def checks(self, harness: Harness) -> list[Check]:
        """Show the distance that the front has run at rest beside both experiments."""
        return [check for aspect in self.aspects for check in self._compare(harness, aspect)]

    def _compare(self, harness: Harness, aspect: float) -> list[Check]:
        column = Cliff(cells=self.cells, aspect=aspect)
        front = column.front(harness.run_until(harness.start(column.scene), column.scene.end_time))
        return [
            Check.absolute(f"H0/L0 = {aspect:g}: run-out, {source}", "L0", front - 1.0, law(aspect), inf)
            for source, law in EXPERIMENTS.items()
        ]
