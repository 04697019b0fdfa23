"""The laws of engine/physics.md in plain NumPy, with the constants of basalt."""

import numpy as np

from tests.helpers.device import Array, transform

RHO0, K, G = 2700.0, 2.67e10, 2.27e10
LONGITUDINAL = K + 4.0 / 3.0 * G
E0, E_IV, E_CV = 4.87e8, 4.72e6, 1.82e7
SMALL_A, SMALL_B, ALPHA, BETA = 0.5, 1.5, 5.0, 5.0
Y0, MU_I, Y_M, U_MELT = 1e7, 1.0, 3.5e9, 3.4e6

FRICTION = {"sugiura2018": 0.839, "talk": 0.945}
"""Coefficient of friction of rubble, mu_d [-], in each parameter set (section 4)."""

MODULUS = {"sugiura2018": LONGITUDINAL, "talk": 9.0 * K * G / (3.0 * K + G)}
"""Modulus [Pa] by which the largest tensile stress is a strain (section 5): of uniaxial strain, and Young's."""

CRACK_SPEED = {"sugiura2018": 0.4, "talk": 0.5}
"""Speed of a crack over that of longitudinal waves [-] (section 5)."""

PER_FLAW = {"sugiura2018": True, "talk": False}
"""Whether damage grows in proportion to the number of active flaws (section 5)."""


def cold(mu: Array, E: Array) -> Array:
    """Pressure [Pa] of compressed or cold matter (section 2); mu = rho/rho0 - 1 keeps small strains exact."""
    eta = 1.0 + mu
    return (SMALL_A + SMALL_B / (E / (E0 * eta**2) + 1.0)) * RHO0 * eta * E + K * mu + K * mu**2


def hot(mu: Array, E: Array) -> Array:
    """Pressure [Pa] of expanded hot matter (section 2)."""
    eta = 1.0 + mu
    stretch = 1.0 / eta - 1.0
    bracket = SMALL_B * RHO0 * eta * E / (E / (E0 * eta**2) + 1.0) + K * mu * np.exp(-BETA * stretch)
    return SMALL_A * RHO0 * eta * E + bracket * np.exp(-ALPHA * stretch**2)


def tillotson(mu: Array, E: Array) -> Array:
    """Pressure [Pa] from compression and energy, none of it below zero; complex arguments give its derivatives."""
    E = np.where(E.real < 0.0, 0.0, E)
    between = ((E - E_IV) * hot(mu, E) + (E_CV - E) * cold(mu, E)) / (E_CV - E_IV)
    condensed = (mu.real >= 0.0) | (E.real < E_IV)
    return np.asarray(np.select([condensed, E.real > E_CV], [cold(mu, E), hot(mu, E)], between))


def squared_sound_speed(mu: Array, E: Array) -> Array:
    """dP/drho + (P/rho^2) dP/dE, without floor, by complex steps, which cancel no digits."""
    tiny = 1e-30
    by_rho = tillotson(mu + 1j * tiny, E + 0j).imag / (tiny * RHO0)
    by_E = tillotson(mu + 0j, E + 1j * tiny * E0).imag / (tiny * E0)
    return np.asarray(by_rho + tillotson(mu, E) / (RHO0 * (1.0 + mu)) ** 2 * by_E)


def strength_limit(P: Array, u: Array, D: Array, friction: float) -> Array:
    """Y = (1-D) Y_i + D Y_d [Pa] (section 4)."""
    P = np.maximum(P, 0.0)
    intact = Y0 + MU_I * P / (1.0 + MU_I * P / (Y_M - Y0))
    intact = intact * np.clip(1.0 - u / U_MELT, 0.0, None)
    return np.asarray((1.0 - D) * intact + D * np.minimum(friction * P, intact))


def log_strain(X: Array) -> Array:
    """ln V of deformation gradients I + X, shape [count, 3, 3], with the digits of small X (section 3)."""
    transposed = X.transpose(0, 2, 1)
    return transform(lambda values: 0.5 * np.log1p(values), X + transposed + X @ transposed)
