"""What every equation of state answers on the host (engine/physics.md, section 2); the device laws are in engine/laws.

A new form is a subclass in a file of its own, and a line in engine.scene.material.AnyEquationOfState.
"""

from abc import abstractmethod
from types import SimpleNamespace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from engine.scene.fields import Frozen

Array = NDArray[np.float64]


class EquationOfState(Frozen):
    """Pressure of matter from compression mu = rho/rho0 - 1 and specific internal energy E.

    Subclasses have a field `form`, the name that a scene gives, and one field for every constant.
    """

    def constants(self) -> dict[str, float]:
        """Every constant by name, in SI units."""
        return self.model_dump(exclude={"form"})

    @abstractmethod
    def pressure(self, rho0: float, mu: Any, E: Any) -> Any:
        """Pressure [Pa] of condensed matter: compressed, or too cold to vaporise.

        Args:
            rho0: reference density [kg/m^3].
            mu: rho/rho0 - 1 [-], a number or an array.
            E: specific internal energy [J/kg], likewise.
        """

    @abstractmethod
    def bulk_modulus(self) -> float:
        """Bulk modulus rho dP/drho [Pa] at the reference state."""

    @abstractmethod
    def compression_at(self, P: Array, rho0: float, keeps_energy: bool) -> tuple[Array, Array]:
        """Compression mu [-] and specific energy E [J/kg] of matter without heat under pressure.

        Args:
            P: pressure [Pa], shape [particle_count].
            rho0: reference density [kg/m^3].
            keeps_energy: whether E counts the work of compression; otherwise it is zero.
        """

    @abstractmethod
    def cold_energy(self, rho0: float, eta: float) -> float:
        """Specific energy [J/kg] of compression without heat: the integral of P(rho, 0)/rho^2 over rho.

        Args:
            rho0: reference density [kg/m^3].
            eta: rho/rho0 at the end [-].
        """

    @abstractmethod
    def vaporisation_energy(self) -> float:
        """Specific energy [J/kg] up to which expanded matter stays condensed; infinite for a form without vapour."""

    @abstractmethod
    def softened(self, factor: float) -> Self:
        """The same form with moduli that let sound travel at `factor` of its speed at the reference state."""


class AlgebraicEquationOfState(EquationOfState):
    """A form whose pressure is plain arithmetic: host and device (engine/laws/algebraic.py) share one formula."""

    @staticmethod
    @abstractmethod
    def formula(m: Any, mu: Any, E: Any) -> tuple[Any, Any]:
        """Pressure [Pa] and squared sound speed [m^2/s^2]; only arithmetic, because the device compiles its source.

        A power is `power(x, y)`, a name of the form's module: the device has its own (engine/device/elementary.py).

        Args:
            m: the constants of the form and `rho0` [kg/m^3], as attributes.
            mu: rho/rho0 - 1 [-].
            E: specific internal energy [J/kg].
        """

    def pressure(self, rho0: float, mu: Any, E: Any) -> Any:
        """Pressure [Pa] from compression and energy; arguments as `EquationOfState.pressure`."""
        return self.formula(SimpleNamespace(rho0=rho0, **self.constants()), mu, E)[0]
