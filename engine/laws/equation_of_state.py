"""What the device laws of all equations of state share: the constants of their materials."""

from collections.abc import Sequence

import taichi as ti

from engine.device.fields import per_body
from engine.scene.material import Material


@ti.data_oriented
class MaterialConstants:
    """Constants of an equation of state and the reference density, one entry per body.

    Args:
        materials: one per body, all with the same form of equation of state.

    Attributes:
        table: `rho0` [kg/m^3] and the constants of the form in SI units, shape [body_count].
    """

    def __init__(self, materials: Sequence[Material]) -> None:
        constants = [{"rho0": material.rho0, **material.eos.constants()} for material in materials]
        self.table = per_body(**{name: [values[name] for values in constants] for name in constants[0]})

    @ti.func
    def rho0(self, body):
        """Return the material's density of the reference state [kg/m^3]."""
        return self.table[body].rho0
