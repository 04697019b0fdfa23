"""State of all particles on the device, in an order that never changes."""

from typing import Any

import taichi as ti
from numpy.typing import NDArray

from engine.backend import Real, capacity, mat3, overwrite, vec3, vec6

Arrays = dict[str, NDArray[Any]]


class Particles:
    """Fields of every particle quantity [SI units].

    x, v: position and velocity; C: affine velocity [1/s]; B, j, E, root, tau: see engine/constitution.py;
    acceleration: gravity held at present; mass; body: index of the body; origin: coordinates of the grid block
    that held the particle when blocks were last built.

    Args:
        count: number of particles.
    """

    STATE = ("x", "v", "C", "B", "j", "E", "root", "tau", "acceleration", "mass", "body", "origin")
    """What a checkpoint holds."""

    def __init__(self, count: int) -> None:
        self.count = count
        shape = capacity(count)
        self.x, self.v, self.acceleration = vec3.field(shape=shape), vec3.field(shape=shape), vec3.field(shape=shape)
        self.C = mat3.field(shape=shape)
        self.B, self.tau = vec6.field(shape=shape), vec6.field(shape=shape)
        self.j, self.E, self.root = ti.field(Real, shape), ti.field(Real, shape), ti.field(Real, shape)
        self.mass = ti.field(Real, shape)
        self.body = ti.field(ti.i32, shape)
        self.origin = ti.Vector.field(3, ti.i32, shape=shape)

    def read(self, *names: str) -> Arrays:
        """Copies of the named fields, first axis the particle."""
        return {name: getattr(self, name).to_numpy()[: self.count] for name in names or self.STATE}

    def write(self, arrays: Arrays) -> None:
        """Overwrite the named fields."""
        for name, values in arrays.items():
            overwrite(getattr(self, name), values)
