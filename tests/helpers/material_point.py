"""Particles that follow a prescribed velocity gradient, without a grid."""

from typing import Any

import numpy as np
import taichi as ti

from engine.device.backend import mat3
from engine.laws.constitution import Constitution
from engine.laws.damage import Damage
from engine.laws.energy import InternalEnergy
from engine.laws.fracture import Unbreakable
from engine.laws.shear import Fluid, Hencky
from engine.laws.strength import Strength, Unlimited
from engine.laws.tillotson import Tillotson
from engine.laws.viscosity import Inviscid
from engine.scene.material import named
from engine.state.particles import Particles
from tests.helpers.device import Array

Gradients = ti.types.ndarray(dtype=mat3, ndim=1)


def unpacked(six: Array) -> Array:
    """Symmetric tensors from their components xx, yy, zz, yz, zx, xy."""
    return six[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


@ti.data_oriented
class Points:
    """Basalt particles and their constitution; what is not asked for is left out."""

    def __init__(
        self,
        count: int,
        strength: bool = False,
        shear: bool = True,
        fracture: Any = None,
        viscosity: Any = None,
        friction: float = 0.839,
    ) -> None:
        materials = [named("basalt", friction=friction)]
        self.particles = Particles(count)
        self.constitution = Constitution(
            self.particles,
            Tillotson(materials),
            InternalEnergy(self.particles),
            Hencky(self.particles, Strength(materials) if strength else Unlimited(), materials) if shear else Fluid(),
            Damage(self.particles, fracture or Unbreakable()),
            viscosity or Inviscid(),
            materials,
        )
        self.wave_speed = np.zeros(count)

    def step(self, L: Array, dt: float) -> None:
        """One time step with velocity gradients `L` [1/s], one for all particles or one each."""
        count = self.particles.count
        self._update(np.ascontiguousarray(np.broadcast_to(L, (count, 3, 3))), dt, self.wave_speed)

    def settle(self) -> None:
        """A step without motion: stress then belongs to the energy and strain at the end, not in between."""
        self.step(np.zeros((3, 3)), 1.0)

    def __getitem__(self, name: str) -> Array:
        """A field of the state."""
        return self.particles.read(name)[name]

    @property
    def J(self) -> Array:
        """det F [-]."""
        return 1.0 + self["j"]

    @property
    def stress(self) -> Array:
        """Cauchy stress [Pa]."""
        return unpacked(self["tau"]) / self.J[:, None, None]

    @property
    def pressure(self) -> Array:
        """Mean stress [Pa], positive in compression."""
        return -np.trace(self.stress, axis1=1, axis2=2) / 3.0

    @property
    def deviator(self) -> Array:
        """Deviatoric Cauchy stress [Pa]."""
        return self.stress + self.pressure[:, None, None] * np.eye(3)

    @ti.kernel
    def _update(self, L: Gradients, dt: ti.f64, speed: ti.types.ndarray(dtype=ti.f64, ndim=1)):
        for p in range(L.shape[0]):
            c, _ = self.constitution.update(p, L[p], dt)
            speed[p] = c
