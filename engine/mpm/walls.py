"""Rigid planes that bound the grid (engine/physics.md, section 11)."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from engine.device.backend import Real, place3, vec3
from engine.device.fields import allocate
from engine.scene.scene import Wall

STICK = -1.0
"""Entry for the friction coefficient of a wall that sticks."""


@ti.data_oriented
class Walls:
    """Planes that nothing crosses; matter may always leave one that does not stick.

    Args:
        walls: the scene's walls, at least one.
    """

    def __init__(self, walls: Sequence[Wall]) -> None:
        self.count = len(walls)
        self.table = allocate(ti.types.struct(normal=place3, level=ti.f64, friction=ti.f64), self.count)
        for i, wall in enumerate(walls):
            normal = np.array(wall.normal) / np.linalg.norm(wall.normal)
            self.table.normal[i] = normal
            self.table.level[i] = float(normal @ wall.point)
            self.table.friction[i] = STICK if wall.friction == "stick" else wall.friction

    @ti.func
    def apply(self, x, velocity):
        """Apply every wall that x is on or behind, in their order."""
        v = velocity
        for i in range(self.count):
            wall = self.table[i]
            if x.dot(wall.normal) <= wall.level:
                v = contact(v, ti.cast(wall.normal, Real), ti.cast(wall.friction, Real))
        return v


@ti.data_oriented
class NoWalls:
    """Space without bounds."""

    @ti.func
    def apply(self, x, velocity):
        """Leave the velocity as it is."""
        return velocity


@ti.func
def contact(v, normal, friction):
    """Return the velocity [m/s] after contact: none into the wall, and along it less Coulomb's impulse.

    Args:
        v: velocity before [m/s].
        normal: unit vector out of the wall.
        friction: Coulomb coefficient [-], or `STICK`.
    """
    result = v
    inward = -v.dot(normal)
    if friction < 0.0:
        result = vec3(0.0)
    elif inward > 0.0:
        along = v + inward * normal
        speed = along.norm()
        kept = ti.cast(0.0, Real)
        if speed > friction * inward:
            kept = 1.0 - friction * inward / speed
        result = kept * along
    return result
