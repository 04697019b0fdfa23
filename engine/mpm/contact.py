"""Where bodies touch: at nodes between surfaces that have met (engine/physics.md, section 1)."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from engine.arrays import Scalars
from engine.device.backend import Real
from engine.device.fields import per_body
from engine.mpm.spline import REACH
from engine.scene.material import Material

INTERVALS = 512
"""Intervals of the table of depths."""


def depth_of(filled: Scalars) -> Scalars:
    """Return how deep [cells] a node lies in a half-space that fills this share of its spline; the integral inverted.

    Args:
        filled: from 0 to 1 [-], of any shape.
    """
    outer = 1.0 / 6.0
    middle = np.sqrt(3.0) * np.sin(
        np.arcsin(4.0 / np.sqrt(3.0) * np.clip(filled - 0.5, outer - 0.5, 0.5 - outer)) / 3.0
    )
    below, above = np.cbrt(6.0 * filled) - REACH, REACH - np.cbrt(6.0 * (1.0 - filled))
    return np.asarray(np.select([filled < outer, filled > 1.0 - outer], [below, above], middle))


@ti.data_oriented
class Contact:
    """Two bodies share the motion of a node if the gap between their surfaces there is closed.

    Args:
        materials: one per body.
        dx: grid spacing [m].
        gap: distance of surfaces at which they touch [cells].
    """

    def __init__(self, materials: Sequence[Material], dx: float, gap: float) -> None:
        self.table = per_body(full=[material.rho0 * dx**3 for material in materials])
        self.depths, self.gap = ti.field(Real, INTERVALS + 1), ti.field(Real, ())
        self.depths.from_numpy(depth_of(np.linspace(0.0, 1.0, INTERVALS + 1)))
        self.gap[None] = gap

    @ti.func
    def depth(self, mass, body):
        """Return the depth of a node that has this mass of a body at the reference density, from the table."""
        place = ti.min(mass / self.table[body].full, 1.0) * INTERVALS
        i = ti.min(ti.cast(place, ti.i32), INTERVALS - 1)
        return self.depths[i] + (place - i) * (self.depths[i + 1] - self.depths[i])

    @ti.func
    def touch(self, deepest, next_deepest):
        """Return whether the gap, -(deepest + next_deepest), is closed."""
        return deepest + next_deepest >= -self.gap[None]


@ti.data_oriented
class SharedNodes:
    """Bodies touch wherever they share nodes: all are one velocity field."""

    @ti.func
    def depth(self, mass, body):
        """Return zero."""
        return ti.cast(0.0, Real)

    @ti.func
    def touch(self, deepest, next_deepest):
        """Return true."""
        return True
