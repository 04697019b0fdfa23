"""Tillotson equation of state with all its branches (engine/physics.md, section 2; Benz & Asphaug 1999)."""

import taichi as ti

from engine.laws.equation_of_state import MaterialConstants

SOUND_SPEED_FLOOR = 0.1
"""Least sound speed, in units of sqrt(A/rho0): expanded states would otherwise stop having one."""


@ti.data_oriented
class Tillotson(MaterialConstants):
    """Pressure and sound speed from compression and energy.

    Args:
        materials: one per body, all of Tillotson's form.
    """

    @ti.func
    def evaluate(self, p, mu, energy, body):
        """Pressure [Pa] and squared sound speed [m^2/s^2].

        Args:
            p: index of the particle.
            mu: rho/rho0 - 1 [-].
            energy: specific internal energy [J/kg]; below zero there is no heat left that could press.
            body: index of the body, which fixes the material.
        """
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
    """Pressure on the cold curve, from compression alone; arguments as for `Tillotson`."""

    @ti.func
    def evaluate(self, p, mu, E, body):
        """Pressure [Pa] and squared sound speed [m^2/s^2]; there is no energy E."""
        m = self.table[body]
        floor = SOUND_SPEED_FLOOR * SOUND_SPEED_FLOOR * m.A
        return (m.A + m.B * mu) * mu, ti.max(m.A + 2.0 * m.B * mu, floor) / m.rho0


@ti.func
def condensed(m, mu, E):
    """Pressure of compressed or cold matter and its derivatives by eta and by e = rho0 E, all in Pa."""
    eta, e = 1.0 + mu, m.rho0 * E
    omega = inverse_omega(m, eta, E)
    P = (m.a + m.b * omega) * eta * e + (m.A + m.B * mu) * mu
    P_eta = (m.a + m.b * omega * (3.0 - 2.0 * omega)) * e + m.A + 2.0 * m.B * mu
    P_e = (m.a + m.b * omega * omega) * eta
    return P, P_eta, P_e


@ti.func
def expanded(m, mu, E):
    """Pressure of expanded hot matter and its derivatives by eta and by e = rho0 E, all in Pa."""
    eta, e = 1.0 + mu, m.rho0 * E
    omega = inverse_omega(m, eta, E)
    J = 1.0 / eta
    stretch = J - 1.0
    gauss = ti.exp(-m.alpha * stretch * stretch)
    cold = m.A * ti.exp(-m.beta * stretch)
    bracket = m.b * omega * eta * e + cold * mu
    bracket_eta = m.b * omega * (3.0 - 2.0 * omega) * e + cold * (1.0 + m.beta * mu * J * J)
    P = m.a * eta * e + bracket * gauss
    P_eta = m.a * e + (bracket_eta + 2.0 * m.alpha * stretch * J * J * bracket) * gauss
    P_e = (m.a + m.b * omega * omega * gauss) * eta
    return P, P_eta, P_e


@ti.func
def inverse_omega(m, eta, E):
    """1 / (E / (E0 eta^2) + 1)."""
    cold = m.E0 * eta * eta
    return cold / (cold + E)
