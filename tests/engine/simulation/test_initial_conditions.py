"""Initial conditions of bodies, and the random numbers they are drawn from."""

import numpy as np
import pytest

from engine.simulation.initial_conditions import Purpose, generator, initial_state
from tests.helpers.device import worst
from tests.helpers.oracle import K
from tests.helpers.scenes import body, scene, started


def test_each_body_and_purpose_has_random_numbers_of_its_own() -> None:
    given, other = scene(body(), body(position=(2e5, 0.0, 0.0))), scene(body(), seed=2)
    drawn = [generator(given, i, purpose).random(4) for i in (0, 1) for purpose in Purpose]
    drawn += [generator(other, 0, purpose).random(4) for purpose in Purpose]
    assert len({tuple(values) for values in drawn}) == 6
    assert np.array_equal(generator(given, 0, Purpose.FLAWS).random(4), drawn[1])


def test_published_seeds_stay() -> None:
    """A change of these numbers changes every result."""
    assert generator(scene(body()), 0, Purpose.POSITIONS).random() == np.random.default_rng([1, 0, 0]).random()
    assert generator(scene(body()), 0, Purpose.FLAWS).random() == np.random.default_rng([1, 0, 1]).random()


def test_bodies_follow_one_another_with_their_mass_motion_and_damage() -> None:
    one = body(particles=30, velocity=(1.0, 2.0, 3.0), damage=0.125)
    two = body(particles=50, radius=20e3, position=(2e5, 0.0, 0.0), spin=(0.0, 0.0, 1e-3), damage=0.0)
    given = scene(one, two)
    state = initial_state(given)
    first = np.arange(80) < 30
    assert np.array_equal(state["body"], np.where(first, 0, 1))
    assert np.bincount(state["body"], state["mass"]) == pytest.approx([each.mass for each in given.bodies])
    assert np.array_equal(state["v"][first], np.tile([1.0, 2.0, 3.0], (30, 1)))
    x = state["x"][~first] - [2e5, 0.0, 0.0]
    np.testing.assert_allclose(state["v"][~first], 1e-3 * np.stack([-x[:, 1], x[:, 0], 0.0 * x[:, 0]], axis=1))
    np.testing.assert_allclose(np.einsum("pij,pj->pi", state["C"][~first], x), state["v"][~first], atol=1e-10)
    assert np.array_equal(state["damage_root"], np.where(first, 0.5, 0.0))


@pytest.mark.usefixtures("taichi")
def test_bodies_start_in_balance_on_the_cold_curve():
    state = started(scene(body(hydrostatic=True), physics={"energy": False})).particles.read("j", "tau", "E")
    mu = -state["j"] / (1.0 + state["j"])
    expected = -state["tau"][:, 0] / (1.0 + state["j"])
    assert worst(K * mu + K * mu**2, expected, expected.max()) < 1e-13
    assert not state["E"].any()
