"""Murnaghan's equation of state (1944, PNAS 30, 244; engine/physics.md, section 2)."""

import math
from operator import pow as power
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field

from engine.scene.equation_of_state import AlgebraicEquationOfState, Array
from engine.scene.fields import Finite, Positive, key


class MurnaghanParameters(AlgebraicEquationOfState):
    """Matter whose bulk modulus is linear in pressure, K + n P; heat makes no pressure."""

    form: Annotated[Literal["murnaghan"], key("form of the equation of state")] = "murnaghan"
    K: Annotated[Positive, key("bulk modulus at the reference state", "Pa")]
    n: Annotated[Finite, Field(gt=1.0), key("derivative dK/dP of the bulk modulus", "1")]

    @staticmethod
    def formula(m: Any, mu: Any, E: Any) -> tuple[Any, Any]:
        """Pressure (K/n) (eta^n - 1) [Pa] and c^2 = K eta^(n-1)/rho0 [m^2/s^2]; arguments as in the base class."""
        eta = 1.0 + mu
        return m.K / m.n * (power(eta, m.n) - 1.0), m.K * power(eta, m.n - 1.0) / m.rho0

    def bulk_modulus(self) -> float:
        """Bulk modulus K [Pa]."""
        return self.K

    def compression_at(self, P: Array, rho0: float, keeps_energy: bool) -> tuple[Array, Array]:
        """Compression (1 + n P/K)^(1/n) - 1 [-] and the energy [J/kg] of it, if it is kept."""
        mu = np.expm1(np.log1p(self.n * P / self.K) / self.n)
        return mu, float(keeps_energy) * self._work(rho0, np.log1p(mu))

    def cold_energy(self, rho0: float, eta: float) -> float:
        """K/(n rho0) [(eta^(n-1) - 1)/(n-1) + 1/eta - 1] [J/kg]."""
        return float(self._work(rho0, math.log(eta)))

    def vaporisation_energy(self) -> float:
        """Infinite: there is no vapour."""
        return math.inf

    def softened(self, factor: float) -> Self:
        """K times the square of `factor`."""
        return self.model_copy(update={"K": factor**2 * self.K})

    def _work(self, rho0: float, log_eta: Any) -> Any:
        """Cold energy [J/kg] from ln eta, which keeps the digits of small compressions."""
        exponent = self.n - 1.0
        return self.K / (self.n * rho0) * (np.expm1(exponent * log_eta) / exponent + np.expm1(-log_eta))
