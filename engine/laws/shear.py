"""Shear stress: Hencky's law up to the strength, or none (engine/physics.md, sections 1, 3 and 4; Klar et al. 2016).

The state is b - I, with b = J^(-2/3) F F^T the isochoric left Cauchy-Green tensor of the elastic strain. Storing b - I
and j = J - 1 instead of F keeps the digits of strains of 1e-6; an isotropic law does not see the rotation in F.
"""

from collections.abc import Sequence

import taichi as ti

from engine.device.backend import Real, mat3, vec6
from engine.device.elementary import power
from engine.device.fields import per_body
from engine.device.tensors import (
    deviator,
    exp_minus_identity,
    half_log,
    identity,
    norm_squared,
    pack,
    unpack,
)
from engine.laws.interfaces import PackingLaw, StrengthLaw
from engine.laws.strength import return_factor
from engine.scene.material import Material
from engine.state.particles import Particles

SMALL_GROWTH = 0.1
"""Relative change of volume in one step [-] up to which the series is used; it is cheaper than the power."""


@ti.func
def isochoric(growth):
    """Return (1 + growth)^(-2/3) - 1: its series to third order up to `SMALL_GROWTH`, the power itself beyond."""
    result = -growth * (2.0 / 3.0 - growth * (5.0 / 9.0 - growth * (40.0 / 81.0)))
    if ti.abs(growth) > SMALL_GROWTH:
        result = power(1.0 + growth, -2.0 / 3.0) - 1.0
    return result


@ti.func
def deform(b_minus_I, H, growth):
    """Return b - I after a step without yielding, b <- det(I + H)^(-2/3) (I + H) b (I + H)^T.

    The isotropic part of b carries no stress; the factor, by which b is isochoric, keeps that part near one.

    Args:
        b_minus_I: isochoric left Cauchy-Green tensor before the step, minus I, six components [-].
        H: displacement gradient dt L of the step [-].
        growth: det(I + H) - 1 [-].
    """
    excess = isochoric(growth)
    strain = unpack(b_minus_I)
    M = H + H @ strain
    increment = M + M.transpose() + M @ H.transpose()
    return pack((1.0 + excess) * (strain + increment) + excess * identity())


@ti.data_oriented
class Hencky:
    """Hencky's law: deviatoric stress linear in the logarithmic strain, limited by strength.

    Args:
        particles: state of the particles.
        strength: largest sqrt(J2).
        packing: of broken rock, which yielding changes.
        materials: one per body.
    """

    def __init__(
        self, particles: Particles, strength: StrengthLaw, packing: PackingLaw, materials: Sequence[Material]
    ) -> None:
        self.b_minus_I, self.strength, self.packing = particles.require("b_minus_I"), strength, packing
        self.table = per_body(modulus=[material.shear_modulus for material in materials])

    @ti.func
    def stress(self, p, H, growth, J, P, E, D, body):
        """Return 2 G dev(ln V) [Pa], scaled back to sqrt(J2) = Y where it is beyond, and store its strain.

        Where Y = 0 the stored strain is zero.
        """
        G, strain, remaining = self.modulus(body), mat3(0.0), vec6(0.0)
        Y, shear = ti.cast(0.0, Real), ti.cast(0.0, Real)
        if self.strength.bears_shear(P, D):
            remaining = deform(self.b_minus_I[p], H, growth)
            strain = deviator(half_log(unpack(remaining)))
            Y = self.strength.limit(p, P, E, D, strain, body)
            factor = return_factor(2.0 * G / J * ti.sqrt(0.5 * norm_squared(strain)), Y)
            if factor < 1.0:
                shear = (1.0 - factor) * ti.sqrt(2.0 * norm_squared(strain))
                strain *= factor
                remaining = pack(exp_minus_identity(2.0 * strain))
        self.b_minus_I[p] = remaining
        self.packing.shear(p, shear, J, P, Y, D, body)
        return 2.0 * G * strain

    @ti.func
    def modulus(self, body):
        """Return the material's shear modulus [Pa]."""
        return self.table[body].modulus

    @ti.func
    def elastic_energy(self, s, body):
        """Return s:s / 4G [J/m^3]."""
        return norm_squared(s) / (4.0 * self.modulus(body))


@ti.data_oriented
class Fluid:
    """No shear stress."""

    @ti.func
    def stress(self, p, H, growth, J, P, E, D, body):
        """Return zero."""
        return mat3(0.0)

    @ti.func
    def modulus(self, body):
        """Return zero."""
        return ti.cast(0.0, Real)

    @ti.func
    def elastic_energy(self, s, body):
        """Return zero."""
        return ti.cast(0.0, Real)
