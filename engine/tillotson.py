"""Tillotson equation of state with all its branches (engine/physics.md, section 2; Benz & Asphaug 1999)."""

from collections.abc import Sequence

import taichi as ti

from engine.backend import Real
from engine.materials import Material

SOUND_SPEED_FLOOR = 0.1
"""Least sound speed, in units of sqrt(A/rho0): expanded states would otherwise stop having one."""


@ti.data_oriented
class Tillotson:
    """Pressure and sound speed from compression and energy.

    Args:
        materials: one per body.
    """

    def __init__(self, materials: Sequence[Material]) -> None:
        constants = ("rho0", "a", "b", "A", "B", "E0", "E_iv", "E_cv", "alpha", "beta")
        self.table = ti.types.struct(**dict.fromkeys(constants, Real)).field(shape=len(materials))
        for i, material in enumerate(materials):
            for name, value in {"rho0": material.rho0, **material.tillotson.model_dump()}.items():
                getattr(self.table, name)[i] = value

    @ti.func
    def pressure(self, mu, E, body):
        """Pressure [Pa] and squared sound speed [m^2/s^2].

        Args:
            mu: rho/rho0 - 1 [-].
            E: specific internal energy [J/kg].
            body: index of the body, which fixes the material.
        """
        m = self.table[body]
        cold_P, cold_rho, cold_E = condensed(m, mu, E)
        P, P_rho, P_E = cold_P, cold_rho, cold_E
        if mu < 0.0 and m.E_iv < E:
            hot_P, hot_rho, hot_E = expanded(m, mu, E)
            hot = ti.min((E - m.E_iv) / (m.E_cv - m.E_iv), 1.0)
            P = hot * hot_P + (1.0 - hot) * cold_P
            P_rho = hot * hot_rho + (1.0 - hot) * cold_rho
            P_E = hot * hot_E + (1.0 - hot) * cold_E
            if hot < 1.0:
                P_E += (hot_P - cold_P) / (m.E_cv - m.E_iv)
        rho = m.rho0 * (1.0 + mu)
        floor = SOUND_SPEED_FLOOR * SOUND_SPEED_FLOOR * m.A / m.rho0
        return P, ti.max(P_rho + P * P_E / (rho * rho), floor)


@ti.data_oriented
class ColdTillotson(Tillotson):
    """Pressure on the cold curve, from compression alone; arguments as `Tillotson`."""

    @ti.func
    def pressure(self, mu, E, body):
        """Pressure [Pa] and squared sound speed [m^2/s^2]; there is no energy E."""
        m = self.table[body]
        floor = SOUND_SPEED_FLOOR * SOUND_SPEED_FLOOR * m.A / m.rho0
        return (m.A + m.B * mu) * mu, ti.max((m.A + 2.0 * m.B * mu) / m.rho0, floor)


@ti.func
def condensed(m, mu, E):
    """Pressure of compressed or cold matter and its derivatives by rho and by E."""
    eta = 1.0 + mu
    rho = m.rho0 * eta
    omega = 1.0 / (E / (m.E0 * eta * eta) + 1.0)
    omega_rho = 2.0 * omega * (1.0 - omega) / rho
    omega_E = -omega * omega / (m.E0 * eta * eta)
    gruneisen = m.a + m.b * omega
    P = gruneisen * rho * E + (m.A + m.B * mu) * mu
    P_rho = (gruneisen + m.b * rho * omega_rho) * E + (m.A + 2.0 * m.B * mu) / m.rho0
    P_E = rho * (gruneisen + m.b * E * omega_E)
    return P, P_rho, P_E


@ti.func
def expanded(m, mu, E):
    """Pressure of expanded hot matter and its derivatives by rho and by E."""
    eta = 1.0 + mu
    rho = m.rho0 * eta
    omega = 1.0 / (E / (m.E0 * eta * eta) + 1.0)
    omega_rho = 2.0 * omega * (1.0 - omega) / rho
    omega_E = -omega * omega / (m.E0 * eta * eta)
    stretch = 1.0 / eta - 1.0
    stretch_rho = -1.0 / (eta * rho)
    gauss = ti.exp(-m.alpha * stretch * stretch)
    cold = m.A * mu * ti.exp(-m.beta * stretch)
    cold_rho = (m.A / m.rho0) * ti.exp(-m.beta * stretch) - m.beta * stretch_rho * cold
    bracket = m.b * rho * E * omega + cold
    bracket_rho = m.b * E * (omega + rho * omega_rho) + cold_rho
    P = m.a * rho * E + bracket * gauss
    P_rho = m.a * E + (bracket_rho - 2.0 * m.alpha * stretch * stretch_rho * bracket) * gauss
    P_E = m.a * rho + m.b * rho * (omega + E * omega_E) * gauss
    return P, P_rho, P_E
