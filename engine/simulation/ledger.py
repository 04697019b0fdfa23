"""Ledger of a simulation: sums over its particles, and their extremes, on the device (engine/physics.md, section 2)."""

from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import taichi as ti

from engine.device.fields import allocate, capacity, components, filled
from engine.device.fixed_order_sum import FixedOrderSum
from engine.gravity.interfaces import GravityField
from engine.quantities import HEATS
from engine.scene.material import Material
from engine.simulation.conservation import Totals
from engine.state.particles import Particles

SCALARS = ("j", "E", *HEATS, "affine_loss", "half_step_work", "damage_root", "plastic_dilation")
"""Quantities that are numbers; not every scene has a field of each."""


@dataclass(frozen=True)
class Extremes:
    """What no particle exceeds.

    Attributes:
        speed: largest speed [m/s].
        density: largest rho/rho0 [-].
        compression: largest rho/rho0 times J_c, the inverse of the density at which broken rock bears pressure [-].
        is_finite: whether all numbers of all particles are.
    """

    speed: float
    density: float
    compression: float
    is_finite: bool


@ti.data_oriented
class Ledger:
    """Sums in double precision and in the order of the scene; that of gravity alone is in the order of the device.

    Args:
        particles: state of the particles.
        materials: of every body.
        gravity: whose work in half a step counts.
        inertia: moment of inertia per mass of the affine motion of a particle [m^2].
        takes_heat: whether internal energy contains the heat of the transfer.
    """

    def __init__(
        self,
        particles: Particles,
        materials: Sequence[Material],
        gravity: GravityField,
        inertia: float,
        takes_heat: bool,
    ) -> None:
        self.particles, self.gravity, self.inertia, self.takes_heat = particles, gravity, inertia, takes_heat
        self.fields = SimpleNamespace(**{name: getattr(particles, name, None) for name in SCALARS})
        self.components = tuple(map(components, particles.fields))
        self.rho0 = filled(ti.f64, np.array([material.rho0 for material in materials]))
        self.bulk = filled(ti.f64, np.array([material.eos.bulk_modulus() for material in materials]))
        self.shear = filled(ti.f64, np.array([material.shear_modulus for material in materials]))
        self.slot = allocate(ti.i32, capacity(particles.count))
        self.motion_sum = FixedOrderSum(self.motion_of, 13, particles.count)
        self.energy_sum = FixedOrderSum(self.energy_of, 12, particles.count)
        self.speed_squared, self.density, self.compression = (allocate(ti.f64) for _ in range(3))
        self.not_finite, self.largest = allocate(ti.f64), allocate(ti.f64)
        self.largest[None] = np.finfo(np.float64).max  # a literal of a kernel would be infinite in single precision

    def totals(self, dt: float) -> Totals:
        """Return the conserved quantities.

        Args:
            dt: length of the last step [s].
        """
        count = self.particles.count
        self.number_slots(count)
        mass, *vectors = self.motion_sum.over(count)
        moment, momentum, orbital, spin = np.reshape(vectors, (4, 3))
        square, affine, internal, elastic, work, falling, affine_loss, *heats, damage, under_pressure = map(
            float, self.energy_sum.over(count)
        )
        return Totals(
            mass=float(mass),
            momentum=momentum,
            angular_momentum=orbital + self.inertia * spin,
            kinetic_energy=0.5 * square,
            affine_kinetic_energy=0.5 * self.inertia * affine,
            internal_energy=internal,
            elastic_energy=elastic,
            gravitational_energy=self.gravity.energy(moment),
            half_step_work=0.5 * dt * falling - work,
            transfer_heat=heats[0],
            plastic_heat=heats[1],
            viscous_heat=heats[2],
            lost_energy=affine_loss + (0.0 if self.takes_heat else heats[0]),
            damaged_fraction=damage / count,
            compressed_fraction=under_pressure / float(mass),
        )

    def extremes(self) -> Extremes:
        """Return what no particle exceeds."""
        self.find_extremes(self.particles.count)
        return Extremes(
            speed=float(np.sqrt(self.speed_squared[None])),
            density=self.density[None],
            compression=self.compression[None],
            is_finite=not self.not_finite[None],
        )

    @ti.kernel
    def number_slots(self, count: ti.i32):
        """Find the index on the device of every particle of the scene."""
        for p in range(count):
            self.slot[self.particles.index[p]] = p

    @ti.func
    def motion_of(self, number):
        """Return m, m x, m v, m x cross v and m times twice the axis of C, of a particle by its number in the scene."""
        p = self.slot[number]
        x, v, C = self.particles.x[p], ti.cast(self.particles.v[p], ti.f64), ti.cast(self.particles.C[p], ti.f64)
        m, L = ti.cast(self.particles.mass[p], ti.f64), x.cross(v)
        spin = ti.Vector([C[2, 1] - C[1, 2], C[0, 2] - C[2, 0], C[1, 0] - C[0, 1]])
        result = ti.Vector.zero(ti.f64, 13)
        result[0] = m
        for i in ti.static(range(3)):
            result[1 + i], result[4 + i], result[7 + i], result[10 + i] = m * x[i], m * v[i], m * L[i], m * spin[i]
        return result

    @ti.func
    def energy_of(self, number):
        """Return energies of a particle, its damage, and its mass if it is under pressure; `totals` names them."""
        p = self.slot[number]
        m, v = ti.cast(self.particles.mass[p], ti.f64), ti.cast(self.particles.v[p], ti.f64)
        C, g = ti.cast(self.particles.C[p], ti.f64), ti.cast(self.gravity.at(p), ti.f64)
        return ti.Vector(
            [
                m * v.norm_sqr(),
                m * (C * C).sum(),
                m * self.value(self.fields.E, p),
                self.elastic_energy(p, m),
                m * self.value(self.fields.half_step_work, p),
                m * v.dot(g),
                m * self.value(self.fields.affine_loss, p),
                m * self.value(self.fields.transfer_heat, p),
                m * self.value(self.fields.plastic_heat, p),
                m * self.value(self.fields.viscous_heat, p),
                self.value(self.fields.damage_root, p) ** 3,
                ti.select(self.value(self.fields.j, p) < self.value(self.fields.plastic_dilation, p), m, 0.0),
            ]
        )

    @ti.func
    def elastic_energy(self, p, m):
        """Return the elastic energy [J], V (P^2/(2K J_c) + s:s/4G) for small strains."""
        body, tau = self.particles.body[p], ti.cast(self.particles.tau[p], ti.f64)
        pressure = -(tau[0] + tau[1] + tau[2]) / 3.0
        square = 2.0 * (tau[3] ** 2 + tau[4] ** 2 + tau[5] ** 2)
        for i in ti.static(range(3)):
            square += (tau[i] + pressure) ** 2
        dilated = 1.0 + self.value(self.fields.plastic_dilation, p)
        density = pressure**2 / (2.0 * self.bulk[body] * dilated) + square / (4.0 * self.shear[body])
        return m / self.rho0[body] * density

    @ti.func
    def value(self, field: ti.template(), p):
        """Return a quantity of particle p; zero where the scene has no field of it."""
        result = ti.cast(0.0, ti.f64)
        if ti.static(isinstance(field, ti.Field)):
            result = ti.cast(field[p], ti.f64)
        return result

    @ti.kernel
    def find_extremes(self, count: ti.i32):
        """Find the extremes of all particles."""
        self.speed_squared[None], self.not_finite[None] = 0.0, 0.0
        self.density[None], self.compression[None] = 0.0, 0.0
        for p in range(count):
            ti.atomic_max(self.speed_squared[None], ti.cast(self.particles.v[p], ti.f64).norm_sqr())
            density = 1.0 / (1.0 + self.value(self.fields.j, p))
            ti.atomic_max(self.density[None], density)
            ti.atomic_max(self.compression[None], (1.0 + self.value(self.fields.plastic_dilation, p)) * density)
        for p in range(count):
            for field in ti.static(self.components):
                for numbers in ti.static(field):
                    if not ti.abs(ti.cast(numbers[p], ti.f64)) <= self.largest[None]:
                        self.not_finite[None] = 1.0
