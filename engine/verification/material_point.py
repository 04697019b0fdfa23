"""Particles of one material under a prescribed velocity gradient, without a grid."""

import numpy as np
import taichi as ti
from numpy.typing import ArrayLike

from engine.device.backend import Real, mat3
from engine.device.taichi_internals import to_numpy_type
from engine.laws.constitution import Constitution
from engine.laws.damage import Damage
from engine.laws.dissipation import NoDissipation
from engine.laws.energy import InternalEnergy
from engine.laws.fracture import Unbreakable
from engine.laws.interfaces import GrowthLaw, ViscosityLaw
from engine.laws.packing import AsDenseAsRock, CriticalState
from engine.laws.shear import Fluid, Hencky
from engine.laws.strength import Strength, Unlimited
from engine.laws.tillotson import Tillotson
from engine.laws.viscosity import Inviscid
from engine.scene.material import Material, named
from engine.state.particles import Particles
from engine.verification.harness import Array

BASALT = named("basalt")

HOST_REAL = to_numpy_type(Real)
"""NumPy's type of the precision of this process."""


def unpacked(six: Array) -> Array:
    """Return symmetric tensors, shape [..., 3, 3], from their components xx, yy, zz, yz, zx, xy, shape [..., 6]."""
    return six[..., [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


@ti.data_oriented
class MaterialPoint:
    """Particles and their constitution: Tillotson's equation of state, internal energy, and the other laws as chosen.

    Args:
        count: number of particles.
        material: of all of them.
        shear: whether they bear shear stress (engine/physics.md, section 3).
        strength: whether strength limits it (section 4).
        fracture: growth of their damage (section 5); without it damage stays.
        viscosity: viscous stress (section 6).

    Attributes:
        particles: their state.
        signal_speed: speed that limits the next time step [m/s], shape [count].
    """

    def __init__(
        self,
        count: int,
        material: Material = BASALT,
        *,
        shear: bool = True,
        strength: bool = False,
        fracture: GrowthLaw | None = None,
        viscosity: ViscosityLaw | None = None,
    ) -> None:
        materials = [material]
        self.particles = Particles(count)
        packing = CriticalState(self.particles, materials) if material.critical_density else AsDenseAsRock()
        limit = Strength(materials, packing) if strength else Unlimited()
        self.constitution = Constitution(
            self.particles,
            Tillotson(materials),
            InternalEnergy(self.particles),
            NoDissipation(),
            packing,
            Hencky(self.particles, limit, packing, materials) if shear else Fluid(),
            Damage(self.particles, fracture or Unbreakable()),
            viscosity or Inviscid(),
        )
        self.signal_speed = np.zeros(count, HOST_REAL)

    def step(self, L: ArrayLike, dt: float) -> None:
        """Advance strain, energy, damage and stress by a step of constant velocity gradient.

        Args:
            L: velocity gradient [1/s], shape [3, 3] for all particles or [count, 3, 3].
            dt: length of the step [s].
        """
        shape = (self.particles.count, 3, 3)
        self._update(np.ascontiguousarray(np.broadcast_to(np.asarray(L, HOST_REAL), shape)), dt, self.signal_speed)

    def settle(self) -> None:
        """Take a step without motion: stress is then that of the energy and strain at the end of the last step."""
        self.step(np.zeros((3, 3)), 1.0)

    def __getitem__(self, name: str) -> Array:
        """Field of the state, first axis the particle (engine/state/particles.py)."""
        return self.particles.read(name)[name]

    @property
    def J(self) -> Array:
        """det F = rho0/rho [-], shape [count]."""
        return 1.0 + self["j"]

    @property
    def stress(self) -> Array:
        """Cauchy stress tau/J [Pa], positive in tension, shape [count, 3, 3]."""
        return unpacked(self["tau"]) / self.J[:, None, None]

    @property
    def pressure(self) -> Array:
        """Mean stress -tr(sigma)/3 [Pa], positive in compression, shape [count]."""
        return np.asarray(-np.trace(self.stress, axis1=1, axis2=2) / 3.0)

    @property
    def deviator(self) -> Array:
        """Deviatoric Cauchy stress [Pa], shape [count, 3, 3]."""
        return self.stress + self.pressure[:, None, None] * np.eye(3)

    @ti.kernel
    def _update(self, L: ti.types.ndarray(dtype=mat3, ndim=1), dt: ti.f64, speed: ti.types.ndarray(dtype=Real, ndim=1)):
        for p in range(L.shape[0]):
            c, _ = self.constitution.update(p, L[p], ti.cast(dt, Real))
            speed[p] = c
