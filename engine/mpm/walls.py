"""Rigid planes that hold the grid back (engine/physics.md, section 11)."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from engine.device.backend import Real, place3, vec3
from engine.scene.scene import Wall

STICK = -1.0
"""Entry for the friction coefficient of a wall that sticks."""


@ti.data_oriented
class Walls:
    """Velocity that planes leave to what is on or behind them; all may always leave a wall that does not stick.

    Args:
        walls: the scene's walls, at least one.
    """

    def __init__(self, walls: Sequence[Wall]) -> None:
        self.count = len(walls)
        self.table = ti.types.struct(normal=place3, level=ti.f64, friction=Real).field(shape=self.count)
        for i, wall in enumerate(walls):
            normal = np.array(wall.normal) / np.linalg.norm(wall.normal)
            self.table.normal[i] = normal
            self.table.level[i] = float(normal @ wall.point)
            self.table.friction[i] = STICK if wall.friction == "stick" else wall.friction

    @ti.func
    def hold(self, x, velocity):
        """Velocity [m/s] that is left at x [m]."""
        v = velocity
        for i in range(self.count):
            wall = self.table[i]
            if x.dot(wall.normal) <= wall.level:
                v = contact(v, ti.cast(wall.normal, Real), wall.friction)
        return v


@ti.func
def contact(v, normal, friction):
    """Velocity after contact: nothing moves into the wall, and Coulomb's impulse slows what slides along it."""
    result = v
    inward = -v.dot(normal)
    if friction < 0.0:
        result = vec3(0.0)
    elif inward > 0.0:
        along = v + inward * normal
        speed = along.norm()
        share = ti.cast(0.0, Real)
        if speed > friction * inward:
            share = 1.0 - friction * inward / speed
        result = share * along
    return result
