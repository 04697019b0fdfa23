"""Shear stress of particles: Hencky's law up to the strength, or none (engine/physics.md, sections 1, 3 and 4).

The state is `B`, the left Cauchy-Green tensor of the isochoric elastic strain minus I. Storing B and j = det F - 1
instead of F keeps the digits of strains of 1e-6; an isotropic law does not see the rotation in F.
"""

from collections.abc import Sequence

import taichi as ti

from engine.device.backend import Real, mat3, vec6
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
from engine.laws.interfaces import StrengthLaw
from engine.laws.strength import return_factor
from engine.scene.material import Material
from engine.state.particles import Particles

SMALL_GROWTH = 0.1
"""Change of volume in one step up to which its powers come from a series."""


@ti.func
def isochoric(growth):
    """(1 + growth)^(-2/3) - 1: to third order in a small growth, and exactly where that would turn negative."""
    result = -growth * (2.0 / 3.0 - growth * (5.0 / 9.0 - growth * (40.0 / 81.0)))
    if ti.abs(growth) > SMALL_GROWTH:
        result = ti.pow(1.0 + growth, -2.0 / 3.0) - 1.0
    return result


@ti.func
def deform(B, A, growth):
    """Trial strain after the displacement gradient A = dt L, which changes the volume by the share `growth`.

    The isotropic part of I + B carries no stress; the factor det(I + A)^(-2/3) keeps it near one.
    """
    excess = isochoric(growth)
    C = unpack(B)
    M = A + A @ C
    increment = M + M.transpose() + M @ A.transpose()
    return pack((1.0 + excess) * (C + increment) + excess * identity())


@ti.data_oriented
class Hencky:
    """Deviatoric stress linear in the logarithmic strain, limited by strength.

    Args:
        particles: state of the particles.
        strength: radial return.
        materials: one per body.
    """

    def __init__(self, particles: Particles, strength: StrengthLaw, materials: Sequence[Material]) -> None:
        self.b_minus_I, self.strength = particles.require("b_minus_I"), strength
        self.table = per_body(modulus=[material.shear_modulus for material in materials])

    @ti.func
    def stress(self, p, A, growth, J, P, E, D, body):
        """Deviatoric Kirchhoff stress [Pa] of particle p after the displacement gradient A.

        What remains elastic after yielding is kept; matter that bears no shear stress keeps no strain.
        """
        G, Y = self.modulus(body), self.strength.limit(p, P, E, D, body)
        strain, remaining = mat3(0.0), vec6(0.0)
        if Y > 0.0:
            remaining = deform(self.b_minus_I[p], A, growth)
            strain = deviator(half_log(unpack(remaining)))
            share = return_factor(2.0 * G / J * ti.sqrt(0.5 * norm_squared(strain)), Y)
            if share < 1.0:
                strain *= share
                remaining = pack(exp_minus_identity(2.0 * strain))
        self.b_minus_I[p] = remaining
        return 2.0 * G * strain

    @ti.func
    def modulus(self, body):
        """Shear modulus [Pa]."""
        return self.table[body].modulus


@ti.data_oriented
class Fluid:
    """Matter without shear stress."""

    @ti.func
    def stress(self, p, A, growth, J, P, E, D, body):
        """No stress."""
        return mat3(0.0)

    @ti.func
    def modulus(self, body):
        """No resistance."""
        return ti.cast(0.0, Real)
