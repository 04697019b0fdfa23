"""State of all particles on the device."""

from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.device.backend import Real, mat3, place3, vec3, vec6
from engine.device.fields import capacity, overwrite

Arrays = dict[str, NDArray[Any]]

FIELD_TYPES = {
    "x": place3,
    "v": vec3,
    "C": mat3,
    "j": Real,
    "tau": vec6,
    "mass": Real,
    "body": ti.i32,
    "origin": ti.types.vector(3, ti.i32),
    "b_minus_I": vec6,
    "E": Real,
    "damage_root": Real,
    "acceleration": vec3,
}
"""Type of every quantity."""

CORE_FIELDS = ("x", "v", "C", "j", "tau", "mass", "body", "origin")
"""Quantities without which no particle moves."""


class Particles:
    """Fields of the particle quantities [SI units] that a scene needs.

    x, v: position and velocity; C: affine velocity [1/s]; j = det F - 1; tau: Kirchhoff stress [Pa]; mass; body: index
    of the body; origin: coordinates of the grid block that held the particle when blocks were last built. Parts of the
    physics hold more: b_minus_I, left Cauchy-Green tensor of the isochoric elastic strain minus I; E, energy [J/kg];
    damage_root, cube root of damage; acceleration, gravity held at present. A quantity that no part requires is
    zero: it is read as zeros, and nothing else can be written to it.

    On the device particles lie in the order of the last `sort`, so that those of a block are read in one go. `index`
    holds their numbers in the scene, which never change and by which `read` and `write` know them.

    Args:
        count: number of particles.
    """

    x: ti.Field
    v: ti.Field
    C: ti.Field
    j: ti.Field
    tau: ti.Field
    mass: ti.Field
    body: ti.Field
    origin: ti.Field

    def __init__(self, count: int) -> None:
        self.count = count
        self.index = ti.field(ti.i32, capacity(count))
        self._number(np.arange(count, dtype=np.int32))
        for name in CORE_FIELDS:
            self.require(name)

    def require(self, name: str) -> Any:
        """The field of a quantity, made when it is first asked for."""
        if name not in self.allocated:
            kind, shape = FIELD_TYPES[name], capacity(self.count)
            setattr(self, name, kind.field(shape=shape) if hasattr(kind, "field") else ti.field(kind, shape))
        return getattr(self, name)

    @property
    def allocated(self) -> tuple[str, ...]:
        """Names of the quantities that have a field: what a checkpoint holds."""
        return tuple(name for name in FIELD_TYPES if name in vars(self))

    def read(self, *names: str) -> Arrays:
        """Copies of the named quantities in double precision, of all when none is named; first axis the particle."""
        return {name: self._values(name) for name in names or FIELD_TYPES}

    def write(self, arrays: Arrays) -> None:
        """Overwrite the named quantities.

        Raises:
            ValueError: a quantity that no part holds would not be zero.
        """
        for name, values in arrays.items():
            if name in self.allocated:
                overwrite(getattr(self, name), values[self.order])
            elif np.any(values):
                raise ValueError(f"no part of the scene holds '{name}': it can only be zero")

    def sort(self, order: NDArray[np.integer[Any]]) -> None:
        """Move all particles on the device.

        Args:
            order: number of the particle that each place receives, shape [particle_count].
        """
        source = np.argsort(self.order)[order]
        for field in (getattr(self, name) for name in self.allocated):
            overwrite(field, field.to_numpy()[source])
        self._number(order)

    def _number(self, order: NDArray[np.integer[Any]]) -> None:
        self.order = order
        overwrite(self.index, order)

    def _values(self, name: str) -> NDArray[Any]:
        if name in self.allocated:
            values = getattr(self, name).to_numpy()[: self.count]
            result = np.empty(values.shape, np.float64 if values.dtype.kind == "f" else values.dtype)
            result[self.order] = values
            return result
        kind = FIELD_TYPES[name]
        return np.zeros((self.count, *(kind.get_shape() if hasattr(kind, "get_shape") else ())))
