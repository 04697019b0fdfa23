"""Tillotson's equation of state with all branches (engine/physics.md, section 2; Benz & Asphaug 1999)."""

import taichi as ti

from engine.device.elementary import exp
from engine.laws.equation_of_state import MaterialConstants

SOUND_SPEED_FLOOR = 0.1
"""Least speed of sound in units of sqrt(A/rho0) [-]: in some expanded states the square is negative."""


@ti.data_oriented
class Tillotson(MaterialConstants):
    """Tillotson's law of compression and energy.

    Args:
        materials: one per body, all of Tillotson's form.
    """

    @ti.func
    def evaluate(self, p, mu, energy, body):
        """Return P [Pa] and dP/drho + (P/rho^2) dP/dE [m^2/s^2]; E < 0 counts as 0 (engine/physics.md, section 2)."""
        m, E = self.table[body], ti.max(energy, 0.0)
        cold_P, cold_eta, cold_e = condensed(m, mu, E)
        P, P_eta, P_e = cold_P, cold_eta, cold_e
        if mu < 0.0 and m.E_iv < E:
            hot_P, hot_eta, hot_e = expanded(m, mu, E)
            hot = ti.min((E - m.E_iv) / (m.E_cv - m.E_iv), 1.0)
            P = hot * hot_P + (1.0 - hot) * cold_P
            P_eta = hot * hot_eta + (1.0 - hot) * cold_eta
            P_e = hot * hot_e + (1.0 - hot) * cold_e
            if hot < 1.0:
                P_e += (hot_P - cold_P) / (m.rho0 * (m.E_cv - m.E_iv))
        eta = 1.0 + mu
        floor = SOUND_SPEED_FLOOR * SOUND_SPEED_FLOOR * m.A
        return P, ti.max(P_eta + P * P_e / (eta * eta), floor) / m.rho0


@ti.data_oriented
class ColdTillotson(Tillotson):
    """Tillotson's law at E = 0; arguments as for `Tillotson`."""

    @ti.func
    def evaluate(self, p, mu, E, body):
        """Return A mu + B mu^2 [Pa] and its derivative by density [m^2/s^2]."""
        m = self.table[body]
        floor = SOUND_SPEED_FLOOR * SOUND_SPEED_FLOOR * m.A
        return (m.A + m.B * mu) * mu, ti.max(m.A + 2.0 * m.B * mu, floor) / m.rho0


@ti.func
def condensed(m, mu, E):
    """Return P [Pa] of compressed or cold matter, dP/d eta [Pa] and dP/de [-], with e = rho0 E.

    Args:
        m: constants of the material.
        mu: rho/rho0 - 1 [-].
        E: specific internal energy [J/kg], not negative.
    """
    eta, e = 1.0 + mu, m.rho0 * E
    omega = inverse_omega(m, eta, E)
    P = (m.a + m.b * omega) * eta * e + (m.A + m.B * mu) * mu
    P_eta = (m.a + m.b * omega * (3.0 - 2.0 * omega)) * e + m.A + 2.0 * m.B * mu
    P_e = (m.a + m.b * omega * omega) * eta
    return P, P_eta, P_e


@ti.func
def expanded(m, mu, E):
    """Return the same of expanded, vaporised matter; arguments as for `condensed`."""
    eta, e = 1.0 + mu, m.rho0 * E
    omega = inverse_omega(m, eta, E)
    J = 1.0 / eta
    stretch = J - 1.0
    gauss = exp(-m.alpha * stretch * stretch)
    cold = m.A * exp(-m.beta * stretch)
    bracket = m.b * omega * eta * e + cold * mu
    bracket_eta = m.b * omega * (3.0 - 2.0 * omega) * e + cold * (1.0 + m.beta * mu * J * J)
    P = m.a * eta * e + bracket * gauss
    P_eta = m.a * e + (bracket_eta + 2.0 * m.alpha * stretch * J * J * bracket) * gauss
    P_e = (m.a + m.b * omega * omega * gauss) * eta
    return P, P_eta, P_e


@ti.func
def inverse_omega(m, eta, E):
    """Return 1 / (E / (E0 eta^2) + 1) [-]; eta is rho/rho0, other arguments as for `condensed`."""
    cold = m.E0 * eta * eta
    return cold / (cold + E)
