"""Constants of Tillotson's equation of state and its answers on the host (engine/physics.md, sections 2 and 8)."""

import math
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import model_validator

from engine.scene.equation_of_state import Array, EquationOfState
from engine.scene.fields import NonNegative, Positive, key


class TillotsonParameters(EquationOfState):
    """Constants of Tillotson 1962 in the form of Benz & Asphaug 1999."""

    form: Annotated[Literal["tillotson"], key("form of the equation of state")] = "tillotson"
    a: Annotated[Positive, key("a of Tillotson's equation of state", "1")]
    b: Annotated[Positive, key("b of Tillotson's equation of state", "1")]
    A: Annotated[Positive, key("bulk modulus A of Tillotson's equation of state", "Pa")]
    B: Annotated[NonNegative, key("modulus B of Tillotson's equation of state", "Pa")]
    E0: Annotated[Positive, key("specific energy E0 of Tillotson's equation of state", "J kg-1")]
    E_iv: Annotated[Positive, key("specific energy of incipient vaporisation", "J kg-1")]
    E_cv: Annotated[Positive, key("specific energy of complete vaporisation", "J kg-1")]
    alpha: Annotated[NonNegative, key("decay alpha of the thermal pressure of vapour", "1")]
    beta: Annotated[NonNegative, key("decay beta of the cold pressure of vapour", "1")]

    @model_validator(mode="after")
    def _vaporises_completely_after_it_begins(self) -> Self:
        if self.E_cv <= self.E_iv:
            raise ValueError(f"'E_cv' {self.E_cv} J/kg must be greater than 'E_iv' {self.E_iv} J/kg")
        return self

    def pressure(self, rho0: float, mu: Any, E: Any) -> Any:
        """Pressure (a + b/w0) rho E + A mu + B mu^2 [Pa] with w0 = E/(E0 eta^2) + 1."""
        eta = 1.0 + mu
        gruneisen = self.a + self.b / (E / (self.E0 * eta**2) + 1.0)
        return gruneisen * (rho0 * eta) * E + self.A * mu + self.B * mu**2

    def bulk_modulus(self) -> float:
        """Bulk modulus A [Pa]."""
        return self.A

    def compression_at(self, P: Array, rho0: float, keeps_energy: bool) -> tuple[Array, Array]:
        """Compression and energy under pressure: the root of P = A mu + (B + (a + b) A/2) mu^2.

        The energy is that of elastic strain, A mu^2 / (2 rho); it presses too (without its own share in w0, 1e-10 of
        its pressure). Matter that keeps no energy is on the cold curve, P = A mu + B mu^2.
        """
        elastic = 0.5 * self.A * float(keeps_energy)
        quadratic = self.B + (self.a + self.b) * elastic
        mu = 2.0 * P / (self.A + np.sqrt(self.A**2 + 4.0 * quadratic * P))
        return mu, elastic * mu**2 / (rho0 * (1.0 + mu))

    def cold_energy(self, rho0: float, eta: float) -> float:
        """The integral of (A mu + B mu^2)/rho^2 over rho [J/kg]."""
        log = math.log(eta)
        return (self.A * (log + 1.0 / eta - 1.0) + self.B * (eta - 1.0 / eta - 2.0 * log)) / rho0

    def vaporisation_energy(self) -> float:
        """Energy of incipient vaporisation E_iv [J/kg]."""
        return self.E_iv

    def softened(self, factor: float) -> Self:
        """A and B times the square of `factor`; what heat does stays."""
        square = factor**2
        return self.model_copy(update={"A": square * self.A, "B": square * self.B})
