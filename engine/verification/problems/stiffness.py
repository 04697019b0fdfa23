"""Independence of a granular flow from its speed of sound (engine/physics.md, sections 4 and 11)."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from engine.verification.check import Check
from engine.verification.harness import Array, Harness, State
from engine.verification.problems.cliff import THIN, Cliff

SCATTER = 0.05
"""RMS of H [L0] between cliffs at rest, 10 cells, whose particles are displaced by 0.1 dx at random: 0.034 to 0.048."""


@dataclass(frozen=True)
class Stiffness:
    """The cliff with c_l = 20 sqrt(g H0) and with twice that; real rock is far stiffer, and would need shorter steps.

    A doubled speed halves the time step, and the transfer damps by the step (engine/physics.md, section 1). So the
    stiff cliff is compared with the soft one at the same cfl, and at the same step, where stiffness alone differs.

    Attributes:
        cells: cells along the initial width.
        cfl: time step of the stiff cliff; the soft one has it too, and half of it.
    """

    name = "stiffness"
    cells: int = 10
    cfl: float = 0.5

    def checks(self, harness: Harness) -> list[Check]:
        """Compare profiles within the scatter of disturbed particles; show the fronts."""
        soft = Cliff(self.cells, cfl=self.cfl)
        stiff = replace(soft, stiffness=2.0 * soft.stiffness)
        after, before = stiff.run(harness), soft.run(harness)
        same_step = replace(soft, cfl=0.5 * self.cfl).run(harness)
        return [
            *_changes("same cfl", soft, before, after),
            *_changes("same step", soft, same_step, after),
        ]


def _changes(what: str, cliff: Cliff, before: dict[str, State], after: dict[str, State]) -> list[Check]:
    checks = []
    for when in before:
        change = rms_difference(cliff.profile(before[when])[1], cliff.profile(after[when])[1])
        fronts = cliff.front(after[when]), cliff.front(before[when])
        checks.append(Check.absolute(f"{when}, {what}: RMS change of H", "L0", change, 0.0, SCATTER))
        checks.append(Check.absolute(f"{when}, {what}: front", "L0", *fronts, inf))
    return checks


def rms_difference(one: Array, other: Array) -> float:
    """Return the RMS difference [L0] of two profiles, up to the farther front."""
    length = max(len(one), len(other))
    padded = np.stack([np.pad(H, (0, length - len(H))) for H in (one, other)])
    covered = padded[:, (padded > THIN).any(axis=0)]
    return float(np.sqrt(np.mean((covered[0] - covered[1]) ** 2)))
