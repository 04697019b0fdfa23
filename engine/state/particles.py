"""State of all particles on the device."""

from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.arrays import Indices
from engine.device.backend import Real, mat3, place3, vec3, vec6
from engine.device.fields import allocate, capacity, overwrite

Arrays = dict[str, NDArray[Any]]
"""Fields of every particle by name, shape [particle_count, ...]: integers for `body` and `origin`, else doubles."""

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
    "half_step_work": Real,
    "transfer_heat": Real,
    "plastic_heat": Real,
    "viscous_heat": Real,
    "affine_loss": Real,
    "damage_root": Real,
    "plastic_dilation": Real,
    "acceleration": vec3,
}
"""Taichi's type of every quantity."""

CORE_FIELDS = ("x", "v", "C", "j", "tau", "mass", "body", "origin")
"""Quantities that every scene allocates."""


class Particles:
    """Fields of the particle quantities that a scene needs.

    Laws and gravity allocate what they store by `require`. A quantity without a field is zero: it is read as zeros, and
    nothing else can be written to it.

    On the device particles lie in the order of the last `sort`, so that those of a block are contiguous in memory. The
    order of the arrays that `read` returns and `write` takes is that of the scene and never changes.

    Args:
        count: number of particles.

    Attributes:
        x, v: position [m] and velocity [m/s].
        C: affine velocity matrix [1/s].
        j: J - 1 [-], with J = det F = rho0/rho.
        tau: Kirchhoff stress J sigma [Pa], six components.
        mass: mass [kg].
        body: index of the body.
        origin: coordinates of the grid block that owned the particle when blocks were last built.
        b_minus_I: b - I [-], six components, with the isochoric left Cauchy-Green tensor b of the elastic strain.
        E: specific internal energy [J/kg].
        half_step_work: specific work of stress in the second half of the last step [J/kg].
        transfer_heat, plastic_heat, viscous_heat: specific energy that motion has lost since the start [J/kg].
        affine_loss: specific energy that the affine motion has lost in free motion since the start [J/kg].
        damage_root: cube root of the damage [-].
        plastic_dilation: J_c - 1 [-], with the J_c = rho0/rho above which broken rock bears no pressure.
        acceleration: by self-gravity [m/s^2].
        index: number in the scene of the particle at each index of the device.
        order: the same on the host, shape [particle_count].
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
        self.index = allocate(ti.i32, capacity(count))
        self._number(np.arange(count, dtype=np.int32))
        for name in CORE_FIELDS:
            self.require(name)

    def require(self, name: str) -> ti.Field:
        """Return the field of a quantity, allocated when it is first asked for."""
        if name not in self.allocated:
            setattr(self, name, allocate(FIELD_TYPES[name], capacity(self.count)))
        return getattr(self, name)

    @property
    def allocated(self) -> tuple[str, ...]:
        """Names of the quantities that have a field."""
        return tuple(name for name in FIELD_TYPES if name in vars(self))

    def read(self, *names: str) -> Arrays:
        """Return copies of the named quantities, of all when none is named, shape [particle_count, ...]."""
        return {name: self._values(name) for name in names or FIELD_TYPES}

    def write(self, arrays: Arrays) -> None:
        """Overwrite quantities of all particles.

        Args:
            arrays: by name, shape [particle_count, ...].

        Raises:
            ValueError: a quantity without a field would not be zero.
        """
        for name, values in arrays.items():
            if name in self.allocated:
                overwrite(getattr(self, name), values[self.order])
            elif np.any(values):
                raise ValueError(f"no part of the scene holds '{name}': it can only be zero")

    def sort(self, order: Indices) -> None:
        """Move all particles on the device.

        Args:
            order: number in the scene of the particle that each index of the device receives, shape [particle_count].
        """
        source = np.argsort(self.order)[order]
        for field in (getattr(self, name) for name in self.allocated):
            overwrite(field, field.to_numpy()[source])
        self._number(order)

    def _number(self, order: Indices) -> None:
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
