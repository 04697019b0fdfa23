import numpy as np
import pytest

from engine.laws.algebraic import Algebraic
from engine.scene.bodies import Sphere
from engine.scene.material import named
from engine.scene.murnaghan import MurnaghanParameters
from engine.scene.scene import Scene
from engine.simulation.initial_conditions import initial_state
from engine.simulation.simulation import Simulation
from tests.helpers.device import Array, evaluate, worst

pytestmark = pytest.mark.usefixtures("taichi")

SOFT = named("basalt", rho0=1000.0, eos=MurnaghanParameters(K=2.0e9, n=7.0))
HARD = named("basalt", rho0=2700.0, eos=MurnaghanParameters(K=2.67e10, n=4.0))


def engine_pressure(mu: Array, E: Array, body: int) -> list[Array]:
    law = Algebraic(MurnaghanParameters.formula, [SOFT, HARD])
    return evaluate(law.evaluate, *indices(mu, 0), mu, E, *indices(mu, body), outputs=((), ()))


def indices(mu: Array, value: int) -> list[Array]:
    return [np.full(len(mu), value, dtype=np.int32)]


@pytest.mark.parametrize(("body", "material"), [(0, SOFT), (1, HARD)])
def test_the_device_has_the_formula_of_the_host(body, material):
    mu = np.concatenate([np.linspace(-0.98, 2.0, 1000), 10.0 ** np.linspace(-9.0, -3.0, 100)])
    E = np.geomspace(1.0, 1e8, len(mu))
    K = material.eos.bulk_modulus()
    P, _ = engine_pressure(mu, E, body)
    expected = material.eos.pressure(material.rho0, mu, E)
    assert worst(P, expected, K + np.abs(expected)) < 1e-14


def test_murnaghan_has_a_modulus_that_is_linear_in_pressure():
    mu = np.linspace(-0.5, 1.0, 500)
    P, c2 = engine_pressure(mu, np.zeros(500), 1)
    modulus = 2700.0 * (1.0 + mu) * c2
    assert worst(modulus, 2.67e10 + 4.0 * P, 2.67e10 + np.abs(modulus)) < 1e-14


def test_murnaghan_in_numbers():
    """K = 2 GPa and n = 7 at twice the density: P = K (128 - 1)/7 and c^2 = 64 K/rho0."""
    P, c2 = engine_pressure(np.array([0.0, 1.0]), np.zeros(2), 0)
    np.testing.assert_allclose(P, [0.0, 127.0 / 7.0 * 2.0e9], rtol=1e-14)
    np.testing.assert_allclose(c2, [2.0e6, 1.28e8], rtol=1e-14)


def test_a_body_of_it_starts_in_balance():
    scene = Scene(bodies=(Sphere(radius=50e3, particles=100, material=HARD),), end_time=1.0)
    state, law = initial_state(scene), Simulation(scene).constitution.eos
    mu = -state["j"] / (1.0 + state["j"])
    P, _ = evaluate(law.evaluate, state["body"], mu, state["E"], state["body"], outputs=((), ()))
    np.testing.assert_allclose(P, -state["tau"][:, 0] / (1.0 + state["j"]), rtol=1e-9)
