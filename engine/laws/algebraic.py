"""Equations of state of plain arithmetic on the device (engine/scene/equation_of_state.py)."""

from collections.abc import Callable, Sequence
from types import FunctionType

import taichi as ti

from engine.device.elementary import power
from engine.laws.equation_of_state import MaterialConstants
from engine.scene.material import Material

Formula = Callable[..., tuple[object, object]]
"""Pressure and squared speed of sound from constants, compression and energy."""


@ti.data_oriented
class Algebraic(MaterialConstants):
    """Pressure and sound speed by the formula of an equation of state on the host.

    Args:
        formula: that of the form, see `AlgebraicEquationOfState` (engine/scene/equation_of_state.py).
        materials: one per body, all of that form.
    """

    def __init__(self, formula: Formula, materials: Sequence[Material]) -> None:
        super().__init__(materials)
        self.formula = device_function(formula)

    @ti.func
    def evaluate(self, p, mu, E, body):
        """Return the formula's pressure and squared speed of sound."""
        return self.formula(self.table[body], mu, E)


def device_function(formula: Formula) -> Formula:
    """Return a function of the host compiled for the device, without its annotations: Taichi would read them."""
    names = {**formula.__globals__, "power": power}
    compiled: Formula = ti.func(FunctionType(formula.__code__, names, formula.__name__))
    return compiled
