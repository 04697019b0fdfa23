"""Newtonian and shock viscosity (engine/physics.md, section 6; von Neumann & Richtmyer 1950)."""

import taichi as ti

from engine.device.backend import Real, mat3
from engine.device.fields import allocate
from engine.device.tensors import deviator, identity
from engine.scene.scene import ViscosityCoefficients


@ti.data_oriented
class Viscosity:
    """Newtonian viscosity, and shock viscosity in compression.

    Args:
        coefficients: of the scene.
        dx: grid spacing [m].
    """

    def __init__(self, coefficients: ViscosityCoefficients, dx: float) -> None:
        constants = {**coefficients.model_dump(), "dx": dx}
        self.table = allocate(ti.types.struct(**dict.fromkeys(constants, Real)))
        for name, value in constants.items():
            getattr(self.table, name)[None] = value

    @ti.func
    def stress(self, p, d, rho, c):
        """Return rho (2 nu dev(d) + zeta tr(d) I) [Pa] and nu + zeta [m^2/s], zeta with the shock viscosity."""
        m = self.table[None]
        divergence = d.trace()
        bulk = m.bulk
        if divergence < 0.0:
            bulk += m.dx * (m.shock_linear * c - m.shock_quadratic * m.dx * divergence)
        stress = rho * (2.0 * m.shear * deviator(d) + bulk * divergence * identity())
        return stress, m.shear + bulk


@ti.data_oriented
class Inviscid:
    """No viscosity."""

    @ti.func
    def stress(self, p, d, rho, c):
        """Return zero stress and diffusivity."""
        return mat3(0.0), ti.cast(0.0, Real)
