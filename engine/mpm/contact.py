"""Where bodies touch: at nodes between surfaces that have met (engine/physics.md, section 1)."""

from collections.abc import Sequence

import numpy as np
import taichi as ti
import taichi.math as tm

from engine.arrays import Scalars
from engine.device.backend import Real
from engine.device.fields import allocate, overwrite, per_body
from engine.mpm.spline import REACH
from engine.scene.material import Material

INTERVALS = 512
"""Intervals of the table of depths."""

ABSENT = 1e-5
"""Ratio of what others fill of a node to what a body fills below which it is round-off of the sum."""


def depth_of(filled: Scalars) -> Scalars:
    """Return how deep [cells] a node lies in a half-space that fills this part of its spline; the integral inverted.

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
class GeometricContact:
    """A body shares the motion of a node with the others if the gap between it and them is closed there.

    Args:
        materials: one per body.
        dx: grid spacing [m].
        gap: distance of surfaces at which they touch [cells].
    """

    separates = True

    def __init__(self, materials: Sequence[Material], dx: float, gap: float) -> None:
        self.table = per_body(full=[material.rho0 * dx**3 for material in materials])
        self.depths, self.gap = allocate(Real, INTERVALS + 1), allocate(Real)
        overwrite(self.depths, depth_of(np.linspace(0.0, 1.0, INTERVALS + 1)))
        self.gap[None] = gap

    @ti.func
    def filled(self, mass, body):
        """Return what a mass [kg] of a body at its reference density fills of a node [-]."""
        return mass / self.table[body].full

    @ti.func
    def touches(self, own, all_bodies):
        """Return whether the gap is closed between a body and all the others together."""
        others = all_bodies - own
        return own > 0.0 and others > ABSENT * own and self.depth(own) + self.depth(others) >= -self.gap[None]

    @ti.func
    def depth(self, filled):
        """Return how deep [cells] a node lies, from the table."""
        position = tm.clamp(filled, 0.0, 1.0) * INTERVALS
        i = ti.min(ti.cast(position, ti.i32), INTERVALS - 1)
        return self.depths[i] + (position - i) * (self.depths[i + 1] - self.depths[i])


@ti.data_oriented
class SharedNodes:
    """Bodies touch wherever they share nodes: all are one velocity field."""

    separates = False

    @ti.func
    def filled(self, mass, body):
        """Return 1."""
        return ti.cast(1.0, Real)

    @ti.func
    def touches(self, own, all_bodies):
        """Return true."""
        return True
