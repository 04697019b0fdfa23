import numpy as np
import pytest

from engine.laws.flaws import Flaws, draw_flaws
from engine.laws.fracture import Fracture, Unbreakable
from engine.scene.scene import Sphere
from tests.helpers.device import Array, compose, evaluate, rotations, worst
from tests.helpers.oracle import CRACK_SPEED, LONGITUDINAL, MODULUS, PER_FLAW, RHO0
from tests.helpers.parameter_sets import rules_of

pytestmark = pytest.mark.usefixtures("taichi")

BODY = Sphere(radius=50e3, particles=500)
CRACK_TIME = 3.0 * BODY.spacing / np.sqrt(LONGITUDINAL / RHO0)
"""Time [s] that a longitudinal wave needs for R_s."""

SETS = pytest.mark.parametrize("name", list(MODULUS))


def drawn(name: str, seed: int = 1) -> Flaws:
    return draw_flaws(BODY, rules_of(name), np.random.default_rng(seed))


def grow(name: str, flaws: Flaws, root: Array, stress: Array, P: Array, dt: Array, p: Array) -> Array:
    law = Fracture([Sphere(radius=1.0, particles=3), BODY], rules_of(name), flaws)
    return evaluate(law.grow, root, stress, P, dt, p, np.ones(len(root), dtype=np.int32))[0]


def oracle(name: str, flaws: Flaws, root: Array, stress: Array, P: Array, dt: Array, p: Array) -> Array:
    """d D^(1/3)/dt = c_g/R_s times the growing cracks, capped by the share of active flaws."""
    strain = (np.linalg.eigvalsh(stress)[:, 2] - P) / MODULUS[name]
    own = [flaws.strain[flaws.first[i] : flaws.first[i + 1]] for i in p]
    active = np.array([(eps < e).sum() for eps, e in zip(own, strain, strict=True)])
    total = np.array([len(eps) for eps in own])
    cracks = active if PER_FLAW[name] else np.minimum(active, 1)
    grown = root + cracks * CRACK_SPEED[name] / CRACK_TIME * dt
    return np.asarray(np.maximum(root, np.minimum(grown, (active / np.maximum(total, 1)) ** (1.0 / 3.0))))


def states(count: int = 4000, seed: int = 1) -> tuple[Array, ...]:
    """Damage, deviatoric stress, pressure, step and particle; tensile strains around those of the flaws."""
    generator = np.random.default_rng(seed)
    values = generator.normal(size=(count, 3))
    values -= values.mean(axis=1, keepdims=True)
    size = LONGITUDINAL * generator.uniform(0.0, 1e-5, count)
    stress = compose(size[:, None] * values, rotations(generator, count))
    P = LONGITUDINAL * generator.uniform(-1e-5, 1e-5, count)
    root = generator.choice([0.0, 1.0, 0.3], count) * generator.uniform(0.0, 1.0, count)
    dt = CRACK_TIME * 10.0 ** generator.uniform(-4.0, 1.0, count)
    return root, stress, P, dt, generator.integers(BODY.particles, size=count).astype(np.int32)


@SETS
def test_growth_follows_the_rules_of_its_parameter_set(name):
    flaws, state = drawn(name), states()
    expected = oracle(name, flaws, *state)
    assert (expected > state[0]).sum() > 500
    assert worst(grow(name, flaws, *state), expected, 1.0) < 1e-14


@SETS
def test_damage_never_falls_and_never_exceeds_one(name):
    flaws, state = drawn(name), states(seed=2)
    grown = grow(name, flaws, *state)
    assert (grown >= state[0]).all() and (grown <= 1.0).all()


@SETS
def test_compression_never_breaks(name):
    root, stress, P, dt, p = states()
    P = np.abs(P) + np.linalg.eigvalsh(stress)[:, 2]
    assert np.array_equal(grow(name, drawn(name), root, stress, P, dt, p), root)


@SETS
def test_fully_damaged_matter_is_left_alone(name):
    root, stress, P, dt, p = states()
    ones = np.ones_like(root)
    assert np.array_equal(grow(name, drawn(name), ones, 1e6 * stress, -1e6 * np.abs(P), dt, p), ones)


@SETS
def test_one_crack_among_four_grows_at_its_speed_up_to_its_share(name):
    """Of two particles with four flaws each, tension opens one flaw of the first and three of the second."""
    flaws = Flaws(np.array([0, 4, 8], dtype=np.int32), np.array([1.0, 3.0, 3.0, 3.0, 1.0, 1.0, 1.0, 3.0]) * 1e-6)
    dt = np.array([0.01, 0.01, 1e3, 1e3]) * CRACK_TIME
    p = np.array([0, 1, 0, 1], dtype=np.int32)
    tension = np.full(4, -2e-6 * MODULUS[name])
    grown = grow(name, flaws, np.zeros(4), np.zeros((4, 3, 3)), tension, dt, p)
    one = 0.01 * CRACK_SPEED[name]
    several = 3.0 * one if PER_FLAW[name] else one
    # damage is the cube of what is integrated, and its cap the share of open flaws
    assert worst(grown**3, np.array([one**3, several**3, 0.25, 0.75]), 1.0) < 1e-15
    assert worst(grown, np.array([one, several, 0.25 ** (1 / 3), 0.75 ** (1 / 3)]), 1.0) < 1e-15


def test_a_particle_without_flaws_does_not_break():
    flaws = Flaws(np.array([0, 0], dtype=np.int32), np.zeros(0))
    grown = grow("talk", flaws, np.zeros(1), np.zeros((1, 3, 3)), np.array([-1e9]), np.ones(1), np.zeros(1, np.int32))
    assert np.array_equal(grown, [0.0])


@SETS
def test_a_flaw_opens_only_beyond_its_strain(name):
    flaws = Flaws(np.array([0, 1], dtype=np.int32), np.array([1e-6]))
    tension = -MODULUS[name] * 1e-6 * np.array([1.0 - 1e-12, 1.0 + 1e-12])
    step, first = np.full(2, CRACK_TIME), np.zeros(2, dtype=np.int32)
    shut, opened = grow(name, flaws, np.zeros(2), np.zeros((2, 3, 3)), tension, step, first)
    assert shut == 0.0 and opened == pytest.approx(CRACK_SPEED[name], rel=1e-15)


def test_unbreakable_matter_keeps_its_damage():
    root, stress, P, dt, p = states(100)
    assert np.array_equal(evaluate(Unbreakable().grow, root, 1e9 * stress, P, dt, p, p)[0], root)
