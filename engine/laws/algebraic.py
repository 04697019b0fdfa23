"""Equations of state of plain arithmetic on the device (engine/scene/equation_of_state.py)."""

from collections.abc import Callable, Sequence
from types import FunctionType
from typing import Any

import taichi as ti

from engine.laws.equation_of_state import MaterialConstants
from engine.scene.material import Material


@ti.data_oriented
class Algebraic(MaterialConstants):
    """Pressure and sound speed by the formula of an equation of state on the host.

    Args:
        formula: that of the form, see engine.scene.equation_of_state.AlgebraicEquationOfState.
        materials: one per body, all of that form.
    """

    def __init__(self, formula: Callable[..., Any], materials: Sequence[Material]) -> None:
        super().__init__(materials)
        self.formula = device_function(formula)

    @ti.func
    def evaluate(self, p, mu, E, body):
        """Pressure [Pa] and squared sound speed [m^2/s^2].

        Args:
            p: index of the particle.
            mu: rho/rho0 - 1 [-].
            E: specific internal energy [J/kg].
            body: index of the body, which fixes the material.
        """
        return self.formula(self.table[body], mu, E)


def device_function(formula: Callable[..., Any]) -> Any:
    """The function of the host compiled for the device, without its annotations, which Taichi takes for its own."""
    return ti.func(FunctionType(formula.__code__, formula.__globals__, formula.__name__))
