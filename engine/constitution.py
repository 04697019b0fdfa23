"""The response of one particle to one step of deformation: the laws, put together.

State of a particle: `B` = left Cauchy-Green tensor of its isochoric elastic strain minus I, `j` = det F - 1,
energy `E`, cube root of damage `root`, and Kirchhoff stress `tau` = J sigma. Storing B and j instead of F keeps
the digits of strains of 1e-6; an isotropic law does not see the rotation in F.
"""

from typing import Any

import taichi as ti

from engine.backend import Real, vec6
from engine.tensors import (
    determinant_increment,
    deviator,
    exp_minus_identity,
    half_log,
    identity,
    norm_squared,
    pack,
    symmetric,
    unpack,
)


@ti.func
def deform(B, j, A):
    """Trial strain after the displacement gradient A = dt L.

    The isotropic part of I + B carries no stress; the factor, det(I + A)^(-2/3) to third order, keeps it near one.
    """
    growth = determinant_increment(A)
    excess = -growth * (2.0 / 3.0 - growth * (5.0 / 9.0 - growth * (40.0 / 81.0)))
    C = unpack(B)
    AC = A @ C
    increment = A + A.transpose() + AC + AC.transpose() + A @ (identity() + C) @ A.transpose()
    return pack((1.0 + excess) * (C + increment) + excess * identity()), j + (1.0 + j) * growth


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
        particles: fields of the state.
        pressure: equation of state.
        strength: radial return.
        fracture: growth of damage.
        viscosity: viscous stress.
        rho0, shear_modulus: one per body.
        shear: whether shear stress is part of the scene.
    """

    def __init__(
        self,
        particles: Any,
        pressure: Any,
        strength: Any,
        fracture: Any,
        viscosity: Any,
        materials: Any,
        shear: bool,
    ) -> None:
        self.particles, self.pressure, self.strength = particles, pressure, strength
        self.fracture, self.viscosity, self.shear = fracture, viscosity, shear
        self.table = ti.types.struct(rho0=Real, shear_modulus=Real).field(shape=len(materials))
        for i, material in enumerate(materials):
            self.table.rho0[i] = material.rho0
            self.table.shear_modulus[i] = material.shear_modulus

    @ti.func
    def update(self, p, L, dt):
        """Advance strain, energy, damage and stress of particle p over one step; returns wave speed and diffusivity.

        Args:
            p: index of the particle.
            L: velocity gradient [1/s].
            dt: time step [s].
        """
        body = self.particles.body[p]
        m = self.table[body]
        B, j = deform(self.particles.B[p], self.particles.j[p], dt * L)
        strain, d = strain_increment(dt * L), symmetric(L)
        half_work = 0.5 / m.rho0 * ddot(unpack(self.particles.tau[p]), strain)
        E = self.particles.E[p] + 2.0 * half_work
        D = self.damage(p)
        P, c2 = self.pressure.pressure(-j / (1.0 + j), E, body)
        if P < 0.0:
            P *= 1.0 - D
        J = 1.0 + j
        s, B = self.shear_stress(B, J, P, E, D, body)
        stress, diffusivity = self.viscosity.stress(d, m.rho0 / J, ti.sqrt(c2))
        tau = s + J * (stress - P * identity())
        self.particles.B[p], self.particles.j[p] = B, j
        self.particles.tau[p] = pack(tau)
        # trapezoidal rule: the work of the mean stress, so that elastic energy does not drift
        self.particles.E[p] += half_work + 0.5 / m.rho0 * ddot(tau, strain)
        self.particles.root[p] = self.fracture.grow(self.particles.root[p], s / J, P, dt, p, body)
        return self.wave_speed(c2, body), diffusivity

    @ti.func
    def shear_stress(self, B, J, P, E, D, body):
        """Deviatoric Kirchhoff stress [Pa] and the elastic strain that remains after yielding."""
        s = identity() * 0.0
        remaining = B
        if ti.static(self.shear):
            G = self.table[body].shear_modulus
            strain = deviator(half_log(unpack(B)))
            root_J2 = 2.0 * G / J * ti.sqrt(0.5 * norm_squared(strain))
            share = self.strength.retained(root_J2, P, E, D, body)
            if share < 1.0:
                strain *= share
                remaining = pack(exp_minus_identity(2.0 * strain))
            s = 2.0 * G * strain
        else:
            remaining = vec6(0.0)
        return s, remaining

    @ti.func
    def damage(self, p):
        """Damage of particle p [-]."""
        root = self.particles.root[p]
        return root * root * root

    @ti.func
    def wave_speed(self, c2, body):
        """Speed of the fastest wave [m/s]."""
        m = self.table[body]
        result = c2
        if ti.static(self.shear):
            result += 4.0 / 3.0 * m.shear_modulus / m.rho0
        return ti.sqrt(result)


@ti.func
def ddot(S, T):
    """S : T of two symmetric tensors."""
    return (
        S[0, 0] * T[0, 0]
        + S[1, 1] * T[1, 1]
        + S[2, 2] * T[2, 2]
        + 2.0 * (S[0, 1] * T[0, 1] + S[0, 2] * T[0, 2] + S[1, 2] * T[1, 2])
    )
