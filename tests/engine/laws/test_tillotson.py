import numpy as np
import pytest

from engine.laws.tillotson import SOUND_SPEED_FLOOR, ColdTillotson, Tillotson
from engine.scene.material import Material, named
from tests.helpers.device import Array, evaluate, worst
from tests.helpers.oracle import E0, E_CV, E_IV, RHO0, K, squared_sound_speed, tillotson

pytestmark = pytest.mark.usefixtures("taichi")

FLOOR = SOUND_SPEED_FLOOR**2 * K / RHO0

HUGONIOT = np.array(
    [
        [25, 3182.2, 0.2148e9, 1.00792],
        [50, 3219.8, 0.4347e9, 1.01577],
        [100, 3295.1, 0.8897e9, 1.03130],
        [200, 3446.2, 1.861e9, 1.06161],
        [500, 3904.5, 5.271e9, 1.14686],
        [1000, 4683.9, 12.65e9, 1.27145],
        [2000, 6298.0, 34.01e9, 1.46534],
    ]
)
"""Particle speed, shock speed [m/s], pressure [Pa], compression: strengthless basalt."""


def engine_pressure(mu: Array, E: Array, material: Material | None = None) -> list[Array]:
    law = Tillotson([named("basalt"), material or named("basalt")])
    body = np.ones(len(mu), dtype=np.int32)
    return evaluate(law.evaluate, body, mu, E, body, outputs=((), ()))


def states() -> tuple[Array, Array]:
    """Compression and energy over all branches, a third of them close to the reference state."""
    generator = np.random.default_rng(1)
    J = np.concatenate([np.exp(generator.uniform(np.log(0.3), np.log(50.0), 6000)), generator.uniform(0.9, 1.1, 4000)])
    E = generator.choice([0.0, 1.0], 10000, p=[0.1, 0.9]) * 10.0 ** generator.uniform(-2.0, 8.0, 10000)
    return 1.0 / J - 1.0, E


def scale(mu: Array, E: Array) -> Array:
    """Size of the terms that pressure is the sum of [Pa]."""
    rho = RHO0 * (1.0 + mu)
    return rho * E + K * np.abs(mu)


def test_pressure_follows_every_branch():
    mu, E = states()
    found, _ = engine_pressure(mu, E)
    for branch in (mu >= 0.0, E < E_IV, (mu < 0.0) & (E > E_CV), (mu < 0.0) & (E > E_IV) & (E < E_CV)):
        assert branch.sum() > 200
    assert worst(found, tillotson(mu, E), scale(mu, E)) < 1e-14


def test_small_compressions_keep_their_digits():
    mu = np.concatenate([10.0 ** np.linspace(-14.0, -3.0, 200), -(10.0 ** np.linspace(-14.0, -3.0, 200))])
    found, _ = engine_pressure(mu, np.zeros(400))
    expected = K * mu + K * mu**2
    assert worst(found, expected, np.abs(expected)) < 1e-14


def test_sound_speed_is_the_derivative_along_the_adiabat():
    mu, E = states()
    _, found = engine_pressure(mu, E)
    expected = np.maximum(squared_sound_speed(mu, E), FLOOR)
    assert worst(found, expected, np.maximum(expected, K / RHO0)) < 1e-12
    assert found.min() == pytest.approx(FLOOR, rel=1e-15)


def test_sound_speed_agrees_with_finite_differences_of_the_pressure():
    mu, E = states()
    # away from the corners between branches, and with a step that balances truncation and round-off
    keep = (np.abs(mu) > 1e-4) & (np.abs(E / E_IV - 1.0) > 1e-4) & (np.abs(E / E_CV - 1.0) > 1e-4) & (E > 1e3)
    mu, E = mu[keep], E[keep]
    rho, step = RHO0 * (1.0 + mu), 1e-6
    ahead, behind = ((1.0 + sign * step) * (1.0 + mu) - 1.0 for sign in (1.0, -1.0))
    by_rho = (engine_pressure(ahead, E)[0] - engine_pressure(behind, E)[0]) / (2.0 * step * rho)
    by_E = (engine_pressure(mu, E * (1.0 + step))[0] - engine_pressure(mu, E * (1.0 - step))[0]) / (2.0 * step * E)
    P, found = engine_pressure(mu, E)
    expected = np.maximum(by_rho + P / rho**2 * by_E, FLOOR)
    assert worst(found, expected, np.maximum(expected, K / RHO0)) < 1e-6


@pytest.mark.parametrize("E", [0.0, 1e6, E_IV, 1e7, E_CV, 1e8])
def test_pressure_is_continuous_across_the_reference_density(E):
    below, at, above = engine_pressure(np.array([-1e-13, 0.0, 1e-13]), np.full(3, E))[0]
    # slopes: A and rho E, so that 1e-13 of compression moves P by at most this much
    assert max(abs(below - at), abs(above - at)) < 1e-12 * (K + 10.0 * RHO0 * E)


@pytest.mark.parametrize("limit", [E_IV, E_CV])
def test_pressure_is_continuous_across_the_limits_of_vaporisation(limit):
    mu = 1.0 / np.geomspace(1.0001, 50.0, 500) - 1.0
    below, at, above = (engine_pressure(mu, np.full(500, limit * factor))[0] for factor in (1 - 1e-13, 1, 1 + 1e-13))
    assert worst(below, at, scale(mu, limit)) < 1e-12
    assert worst(above, at, scale(mu, limit)) < 1e-12


def test_spot_values():
    mu, E = np.array([0.0, 0.0, 0.1, -0.001, -0.5]), np.array([0.0, 4.87e8, 0.0, 0.0, 4.87e8 / 4.0])
    hot_half = 0.5 * 1350 * E0 / 4 + (1.5 * 1350 * E0 / 8 - 1.335e10 * np.exp(-5.0)) * np.exp(-5.0)
    expected = np.array([0.0, 1.25 * 2700 * 4.87e8, 2.937e9, -2.67e7 + 2.67e4, hot_half])
    P, c2 = engine_pressure(mu, E)
    assert worst(P, expected, 1e9) < 1e-14
    assert np.sqrt(c2[0]) == pytest.approx(3144.66, abs=0.01)


def test_each_body_has_its_own_material():
    soft = named("basalt", rho0=1000.0, eos={"A": 1e9, "B": 2e9})
    assert engine_pressure(np.array([0.1]), np.zeros(1), soft)[0][0] == pytest.approx(1e8 + 2e7)


def test_the_strengthless_hugoniot():
    up, shock_speed, pressure, compression = HUGONIOT.T
    eta = np.linspace(1.001, 1.6, 20001)
    speed = np.repeat(up, len(eta))
    trial = np.tile(eta, len(up))
    P, _ = engine_pressure(trial - 1.0, 0.5 * speed**2)
    # pressure of the equation of state minus that of the jump conditions: it rises through zero at the shocked state
    excess = (P - RHO0 * speed**2 * trial / (trial - 1.0)).reshape(len(up), -1)
    shocked = np.array([np.interp(0.0, row, eta) for row in excess])
    us = up * shocked / (shocked - 1.0)
    # half a unit of the last digit that the table prints
    assert worst(shocked, compression, 1.0) < 0.51e-5
    assert worst(us, shock_speed, shock_speed) < 1.6e-5
    assert worst(RHO0 * us * up, pressure, pressure) < 5e-4


def test_matter_without_heat_follows_the_cold_curve():
    """Also where the fit has its pole, E = -E0 eta^2."""
    J = np.array([0.5, 0.9, 1.1, 5.0, 50.0])
    mu = 1.0 / J - 1.0
    cold, _ = engine_pressure(mu, np.zeros(5))
    for E in (-1.0 * np.ones(5), -E0 / J**2, -1e8 * np.ones(5)):
        P, c2 = engine_pressure(mu, E)
        np.testing.assert_array_equal(P, cold)
        assert (c2 >= FLOOR).all() and np.isfinite(c2).all()


def test_without_energy_pressure_follows_the_cold_curve():
    law = ColdTillotson([named("basalt")])
    mu, zeros = np.linspace(-0.4, 3.0, 500), np.zeros(500, np.int32)
    P, c2 = evaluate(law.evaluate, zeros, mu, np.full(500, 1e8), zeros, outputs=((), ()))
    assert worst(P, K * mu + K * mu**2, K * np.abs(mu)) < 1e-15
    assert worst(c2, (K + 2.0 * K * mu) / RHO0, K / RHO0) < 1e-15
