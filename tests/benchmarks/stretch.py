"""The usual response of a particle, to compare with: a full deformation gradient, decomposed in every step.

The laws are the engine's (engine/physics.md, sections 2-5; Klar et al. 2016 for the return in log strains).
"""

from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.device.backend import mat3, vec3
from engine.device.fields import overwrite
from engine.device.tensors import identity, pack, unpack
from engine.laws.constitution import Constitution, ddot, strain_increment
from engine.laws.strength import return_factor
from engine.state.particles import Arrays


@ti.data_oriented
class StretchConstitution(Constitution):
    """Stress, energy and damage of one particle from the singular values of its deformation gradient F.

    The arguments are those of `Constitution`; B and j of the particles give F at the start, and B is not used again.
    """

    def __init__(self, *parts: Any) -> None:
        super().__init__(*parts)
        self.F = mat3.field(shape=self.particles.x.shape)
        overwrite(self.F, deformation_gradient(self.particles.read("b_minus_I", "j")))

    def volume_ratio(self) -> NDArray[np.float64]:
        """det F of every particle."""
        return np.asarray(np.linalg.det(self.F.to_numpy()[: self.particles.count]))

    @ti.func
    def update(self, p, L, dt):
        """Advance strain, energy, damage and stress of particle p over one step of velocity gradient L."""
        body = self.particles.body[p]
        rho0 = self.eos.rho0(body)
        F = (identity() + dt * L) @ self.F[p]
        J = F.determinant()
        strain = strain_increment(dt * L)
        half_work = 0.5 / rho0 * ddot(unpack(self.particles.tau[p]), strain)
        E = self.energy.after(p, 2.0 * half_work)
        P, c2 = self.eos.evaluate(p, 1.0 / J - 1.0, E, body)
        if P < 0.0:
            P *= 1.0 - self.damage.value(p)
        F, s, largest = self.shear_part(F, J, P, E, p)
        tau = s - J * P * identity()
        self.F[p], self.particles.j[p], self.particles.tau[p] = F, J - 1.0, pack(tau)
        self.energy.work(p, half_work, 0.5 / rho0 * ddot(tau, strain))
        self.damage.damage_root[p] = self.grow(largest / J - P, dt, p)
        return self.signal_speed_of(c2, body), 0.0

    @ti.func
    def shear_part(self, F, J, P, E, p):
        """Elastic F after yielding, deviatoric Kirchhoff stress [Pa] and its largest principal value."""
        body = self.particles.body[p]
        G = self.shear.modulus(body)
        U, S, V = ti.svd(F)
        logs = vec3(ti.log(S[0, 0]), ti.log(S[1, 1]), ti.log(S[2, 2]))
        strain = logs - logs.sum() / 3.0
        root_J2 = 2.0 * G / J * ti.sqrt(0.5 * strain.norm_sqr())
        direction = U @ diagonal(strain) @ U.transpose()
        share = return_factor(root_J2, self.shear.strength.limit(p, P, E, self.damage.value(p), direction, body))
        elastic = F
        if share < 1.0:
            elastic = U @ diagonal(ti.exp(logs - (1.0 - share) * strain)) @ V.transpose()
            strain *= share
        principal = 2.0 * G * strain
        return elastic, U @ diagonal(principal) @ U.transpose(), principal.max()

    @ti.func
    def grow(self, tension, dt, p):
        """Cube root of damage after a step under a largest principal stress [Pa]."""
        m, root = self.damage.fracture.table[self.particles.body[p]], self.damage.damage_root[p]
        first, end = self.damage.fracture.first[p], self.damage.fracture.first[p + 1]
        flaw = first
        while flaw < end and self.damage.fracture.strain[flaw] < tension / m.modulus:
            flaw += 1
        active = flaw - first
        if active > 0:
            cracks = active if ti.static(self.damage.fracture.per_flaw) else 1
            root = ti.max(root, ti.min(root + cracks * m.rate * dt, (active / (end - first)) ** (1.0 / 3.0)))
        return root


@ti.func
def diagonal(values):
    """Diagonal matrix."""
    return mat3(values[0], 0.0, 0.0, 0.0, values[1], 0.0, 0.0, 0.0, values[2])


def deformation_gradient(state: Arrays) -> NDArray[np.float64]:
    """F without rotation for the engine's isochoric strain B and det F - 1, shape [particle_count, 3, 3]."""
    b = np.eye(3) + state["b_minus_I"][:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]
    values, vectors = np.linalg.eigh(b)
    stretch = np.sqrt(values)
    stretch *= np.cbrt((1.0 + state["j"]) / stretch.prod(axis=1))[:, None]
    return np.asarray(np.einsum("nik,nk,njk->nij", vectors, stretch, vectors))
