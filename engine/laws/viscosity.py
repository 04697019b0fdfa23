"""Newtonian and shock viscosity (engine/physics.md, section 6; von Neumann & Richtmyer 1950)."""

import taichi as ti

from engine.device.backend import Real, mat3
from engine.device.tensors import deviator, identity
from engine.scene.scene import ViscosityCoefficients


@ti.data_oriented
class Viscosity:
    """Viscous stress of one particle.

    Args:
        coefficients: the scene's viscosity.
        dx: grid spacing [m].
    """

    def __init__(self, coefficients: ViscosityCoefficients, dx: float) -> None:
        constants = {**coefficients.model_dump(), "dx": dx}
        self.table = ti.types.struct(**dict.fromkeys(constants, Real)).field(shape=())
        for name, value in constants.items():
            getattr(self.table, name)[None] = value

    @ti.func
    def stress(self, d, rho, c):
        """Viscous Cauchy stress [Pa], positive in tension, and the diffusivity [m^2/s] that limits the time step.

        Args:
            d: symmetric velocity gradient [1/s].
            rho: density [kg/m^3].
            c: sound speed [m/s].
        """
        m = self.table[None]
        divergence = d.trace()
        bulk = m.bulk
        if divergence < 0.0:
            bulk += m.dx * (m.shock_linear * c - m.shock_quadratic * m.dx * divergence)
        stress = rho * (2.0 * m.shear * deviator(d) + bulk * divergence * identity())
        return stress, m.shear + bulk


@ti.data_oriented
class Inviscid:
    """Matter without viscosity."""

    @ti.func
    def stress(self, d, rho, c):
        """No stress and no limit."""
        return mat3(0.0), ti.cast(0.0, Real)
