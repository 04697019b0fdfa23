"""Independence of a granular flow from its speed of sound (engine/physics.md, sections 4 and 11)."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from engine.verification.check import Check
from engine.verification.harness import Array, Harness, State
from engine.verification.problems.cliff import THIN, Cliff

SCATTER = 0.05
"""RMS of H [L0] between cliffs at rest, 10 cells, whose particles are displaced by 0.1 dx at random: 0.039 to 0.050."""

OTHER_RATE = 0.1
"""The same at another rate of the filter, which is another damping: what the cliff may be off Jutzi's."""


@dataclass(frozen=True)
class Stiffness:
    """The cliff with c_l = 20 sqrt(g H0) and with twice that; real rock is far stiffer, and would need shorter steps.

    A doubled speed also doubles the rate (c_l + v_m)/(filter_time dx) at which the transfer filters (engine/physics.md,
    section 1). So the stiff cliff is compared with the soft one once as it is, and once with the soft one's rate, where
    stiffness alone differs.

    Attributes:
        cells: cells along the initial width.
    """

    name = "stiffness"
    cells: int = 10

    def checks(self, harness: Harness) -> list[Check]:
        """Compare profiles at one rate within the scatter of disturbed particles; show those at another, and fronts."""
        soft = Cliff(self.cells)
        stiff = replace(soft, stiffness=2.0 * soft.stiffness)
        same_rate = replace(stiff, filter_time=2.0 * stiff.filter_time)
        before = soft.run(harness)
        return [
            *_changes("same filter_time", soft, before, stiff.run(harness), OTHER_RATE),
            *_changes("same rate", soft, before, same_rate.run(harness), SCATTER),
        ]


def _changes(what: str, cliff: Cliff, before: dict[str, State], after: dict[str, State], allowed: float) -> list[Check]:
    checks = []
    for when in before:
        change = rms_difference(cliff.profile(before[when])[1], cliff.profile(after[when])[1])
        fronts = cliff.front(after[when]), cliff.front(before[when])
        checks.append(Check.absolute(f"{when}, {what}: RMS change of H", "L0", change, 0.0, allowed))
        checks.append(Check.absolute(f"{when}, {what}: front", "L0", *fronts, inf))
    return checks


def rms_difference(one: Array, other: Array) -> float:
    """Return the RMS difference [L0] of two profiles, up to the farther front."""
    length = max(len(one), len(other))
    padded = np.stack([np.pad(H, (0, length - len(H))) for H in (one, other)])
    covered = padded[:, (padded > THIN).any(axis=0)]
    return float(np.sqrt(np.mean((covered[0] - covered[1]) ** 2)))
