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

    On the device the particles of a block are contiguous in memory. The order of the arrays that `read` returns and
    `write` takes is that of the scene and never changes.

    Args:
        count: number of particles.

    Attributes:
        number: of particles, on the device: kernels are the same for any.
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
        listed: these numbers body by body.
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
        self.count, self.number = count, allocate(ti.i32)
        self.number[None] = count
        self.index, self.listed = (allocate(ti.i32, capacity(count)) for _ in range(2))
        for field in (self.index, self.listed):
            overwrite(field, np.arange(count, dtype=np.int32))
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
        order = self.order
        return {name: self._values(name, order) for name in names or FIELD_TYPES}

    def write(self, arrays: Arrays) -> None:
        """Overwrite quantities of all particles.

        Args:
            arrays: by name, shape [particle_count, ...].

        Raises:
            ValueError: a quantity without a field would not be zero.
        """
        order = self.order
        if "body" in arrays:
            overwrite(self.listed, np.argsort(arrays["body"], kind="stable"))
        for name, values in arrays.items():
            if name in self.allocated:
                overwrite(getattr(self, name), values[order])
            elif np.any(values):
                raise ValueError(f"no part of the scene holds '{name}': it can only be zero")

    @property
    def order(self) -> Indices:
        """Number in the scene of the particle at each index of the device, shape [particle_count]."""
        return np.asarray(self.index.to_numpy()[: self.count])

    @property
    def fields(self) -> list[ti.Field]:
        """Fields that move with the particles: the index, and all quantities that have one."""
        return [self.index, *(getattr(self, name) for name in self.allocated)]

    def _values(self, name: str, order: Indices) -> NDArray[Any]:
        if name in self.allocated:
            values = getattr(self, name).to_numpy()[: self.count]
            result = np.empty(values.shape, np.float64 if values.dtype.kind == "f" else values.dtype)
            result[order] = values
            return result
        kind = FIELD_TYPES[name]
        return np.zeros((self.count, *(kind.get_shape() if hasattr(kind, "get_shape") else ())))
