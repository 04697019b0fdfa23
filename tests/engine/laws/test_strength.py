import numpy as np
import pytest

from engine.laws.packing import AsDenseAsRock
from engine.laws.strength import Strength, Unlimited, return_factor
from engine.scene.material import named
from tests.helpers.device import Array, evaluate, worst
from tests.helpers.oracle import FRICTION, U_MELT, strength_limit
from tests.helpers.parameter_sets import friction_of

pytestmark = pytest.mark.usefixtures("taichi")

SETS = list(FRICTION)


def law(name: str) -> Strength:
    return Strength([named("basalt"), named("basalt", friction=friction_of(name))], AsDenseAsRock())


def engine_limit(name: str, P: Array, E: Array, D: Array) -> Array:
    numbers = np.ones(len(P), dtype=np.int32)
    return evaluate(law(name).limit, numbers, P, E, D, np.zeros((len(P), 3, 3)), numbers)[0]


def states(count: int = 6000) -> tuple[Array, Array, Array]:
    """Pressure of both signs over ten decades, energy past melting, damage with both ends exactly."""
    generator = np.random.default_rng(1)
    P = generator.choice([-1.0, 0.0, 1.0], count, p=[0.2, 0.1, 0.7]) * 10.0 ** generator.uniform(1.0, 11.0, count)
    u = generator.choice([0.0, 1.0, 1.0], count) * generator.uniform(0.0, 1.5 * U_MELT, count)
    D = np.clip(generator.uniform(-0.5, 1.5, count), 0.0, 1.0)
    return P, u, D


@pytest.mark.parametrize("name", SETS)
def test_limit_equals_the_closed_form(name):
    P, u, D = states()
    expected = strength_limit(P, u, D, FRICTION[name])
    assert worst(engine_limit(name, P, u, D), expected, np.maximum(expected, 1.0)) < 1e-14


@pytest.mark.parametrize("name", SETS)
def test_spot_values(name):
    P, E, D = np.array(
        [
            [0.0, 0.0, 0.0],
            [-1e9, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [-1e9, 0.0, 1.0],
            [1e6, 0.0, 1.0],
            [1e6, 0.0, 0.5],
            [1e30, 0.0, 0.0],
            [1e30, 0.0, 1.0],
            [0.0, U_MELT / 2, 0.0],
            [1e9, U_MELT, 0.0],
            [1e9, 2 * U_MELT, 1.0],
        ]
    ).T
    mu_d = FRICTION[name]
    half_damaged = 0.5 * (1e7 + 1e6 / (1 + 1e6 / 3.49e9)) + 0.5 * mu_d * 1e6
    expected = np.array([1e7, 1e7, 0.0, 0.0, mu_d * 1e6, half_damaged, 3.5e9, 3.5e9, 0.5e7, 0.0, 0.0])
    assert worst(engine_limit(name, P, E, D), expected, 1e7) < 1e-14


def test_the_talks_friction_is_the_cone_of_forty_degrees():
    sine = np.sin(np.deg2rad(40.0))
    assert FRICTION["talk"] == pytest.approx(2.0 * np.sqrt(3.0) * sine / (3.0 - sine), abs=5e-4)
    assert FRICTION["sugiura2018"] == pytest.approx(np.tan(np.deg2rad(40.0)), abs=5e-4)


@pytest.mark.parametrize("name", SETS)
def test_limit_never_falls_with_pressure_and_never_rises_with_damage(name):
    P, u, D = states()
    here = engine_limit(name, P, u, D)
    assert (engine_limit(name, P + 0.1 * np.abs(P), u, D) >= here * (1.0 - 1e-15)).all()
    assert (engine_limit(name, P, u, np.minimum(D + 0.1, 1.0)) <= here * (1.0 + 1e-15)).all()


@pytest.mark.parametrize("name", SETS)
def test_the_return_factor_is_exactly_one_up_to_the_limit_and_their_ratio_beyond(name):
    P, u, D = states()
    Y = engine_limit(name, P, u, D)
    root_J2 = Y * np.random.default_rng(2).choice([0.0, 0.5, 1.0, 1.0 + 1e-12, 2.0, 1e6], len(Y))
    root_J2[Y == 0.0] = np.resize([0.0, 1e-6, 1e9], (Y == 0.0).sum())
    (found,) = evaluate(return_factor, root_J2, Y)
    elastic = root_J2 <= Y
    assert elastic.sum() > 1000 and (~elastic).sum() > 1000
    assert np.array_equal(found[elastic], np.ones(elastic.sum()))
    assert worst(found[~elastic], Y[~elastic] / root_J2[~elastic], 1.0) < 1e-15


def test_an_unlimited_solid_keeps_all_strain():
    P, u, D = states(100)
    numbers = np.zeros(100, dtype=np.int32)
    (Y,) = evaluate(Unlimited().limit, numbers, P, u, D, np.zeros((100, 3, 3)), numbers)
    (found,) = evaluate(return_factor, np.full(100, 1e20), Y)
    assert np.array_equal(found, np.ones(100))
