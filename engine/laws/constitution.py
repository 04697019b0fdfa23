"""The response of one particle to one step of deformation: the laws, put together.

State of every particle: `j` = det F - 1 and Kirchhoff stress `tau` = J sigma; the laws hold what else they need.
"""

from collections.abc import Sequence

import taichi as ti

from engine.device.backend import Real
from engine.device.tensors import determinant_increment, identity, pack, symmetric, unpack
from engine.laws.interfaces import DamageLaw, EnergyLaw, EquationOfStateLaw, ShearLaw, ViscosityLaw
from engine.scene.material import Material
from engine.state.particles import Particles


@ti.func
def strain_increment(A):
    """Logarithmic strain sym(ln(I + A)) of the displacement gradient A, to second order.

    A step of rigid rotation stretches a little, -A^2 / 2: without it a spinning body would lose energy.
    """
    return symmetric(A - 0.5 * (A @ A))


@ti.data_oriented
class Constitution:
    """Stress, energy and damage of one particle.

    Args:
        particles: state of the particles.
        eos: equation of state; its `evaluate` gives pressure and squared sound speed.
        energy: internal energy.
        shear: shear stress, with its strength.
        damage: damage, with its growth.
        viscosity: viscous stress.
        materials: one per body.
    """

    def __init__(
        self,
        particles: Particles,
        eos: EquationOfStateLaw,
        energy: EnergyLaw,
        shear: ShearLaw,
        damage: DamageLaw,
        viscosity: ViscosityLaw,
        materials: Sequence[Material],
    ) -> None:
        self.particles, self.eos, self.energy = particles, eos, energy
        self.shear, self.damage, self.viscosity = shear, damage, viscosity
        self.table = ti.types.struct(rho0=Real).field(shape=len(materials))
        for i, material in enumerate(materials):
            self.table.rho0[i] = material.rho0

    @ti.func
    def update(self, p, L, dt):
        """Advance strain, energy, damage and stress of particle p over one step; returns wave speed and diffusivity.

        Args:
            p: index of the particle.
            L: velocity gradient [1/s].
            dt: time step [s].
        """
        body = self.particles.body[p]
        m, A = self.table[body], dt * L
        growth, strain = determinant_increment(A), strain_increment(A)
        j = self.particles.j[p] + (1.0 + self.particles.j[p]) * growth
        half_work = 0.5 / m.rho0 * ddot(unpack(self.particles.tau[p]), strain)
        E, D = self.energy.after(p, 2.0 * half_work), self.damage.value(p)
        J = 1.0 + j
        P, c2 = self.eos.evaluate(p, -j / J, E, body)
        if P < 0.0:
            P *= 1.0 - D
        s = self.shear.stress(p, A, growth, J, P, E, D, body)
        stress, diffusivity = self.viscosity.stress(p, symmetric(L), m.rho0 / J, ti.sqrt(c2))
        tau = s + J * (stress - P * identity())
        self.particles.j[p], self.particles.tau[p] = j, pack(tau)
        # trapezoidal rule: the work of the mean stress, so that elastic energy does not drift
        self.energy.add(p, half_work + 0.5 / m.rho0 * ddot(tau, strain))
        self.damage.grow(p, s / J, P, dt, body)
        return self.wave_speed(c2, body), diffusivity

    @ti.func
    def rho0(self, p):
        """Return the density of the reference state [kg/m^3] of particle p."""
        return self.table[self.particles.body[p]].rho0

    @ti.func
    def signal_speed(self, p):
        """Speed of the fastest wave [m/s] in particle p as it is."""
        body, J = self.particles.body[p], 1.0 + self.particles.j[p]
        _, c2 = self.eos.evaluate(p, -self.particles.j[p] / J, self.energy.after(p, 0.0), body)
        return self.wave_speed(c2, body)

    @ti.func
    def wave_speed(self, c2, body):
        """Speed of the fastest wave [m/s]."""
        return ti.sqrt(c2 + 4.0 / 3.0 * self.shear.modulus(body) / self.table[body].rho0)


@ti.func
def ddot(S, T):
    """S : T of two symmetric tensors."""
    return (
        S[0, 0] * T[0, 0]
        + S[1, 1] * T[1, 1]
        + S[2, 2] * T[2, 2]
        + 2.0 * (S[0, 1] * T[0, 1] + S[0, 2] * T[0, 2] + S[1, 2] * T[1, 2])
    )
