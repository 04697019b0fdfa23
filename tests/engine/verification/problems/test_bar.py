"""Rock pulled at a constant rate, with all laws at once and without a grid."""

import numpy as np
import pytest

from engine.laws.flaws import Flaws, draw_flaws
from engine.laws.fracture import Fracture
from engine.scene.material import named
from engine.scene.scene import Sphere
from engine.verification.material_point import MaterialPoint
from engine.verification.problems.bar import Bar, Pull
from tests.helpers.device import Array, worst
from tests.helpers.oracle import CRACK_SPEED, FRICTION, LONGITUDINAL, MODULUS, RHO0, G, strength_limit, tillotson
from tests.helpers.parameter_sets import rules_of

BODY = Sphere(radius=1.0, particles=200)
STEPS = 600


def drawn(name: str) -> Flaws:
    return draw_flaws(BODY, rules_of(name), np.random.default_rng(1))


def engine_bar(name: str, rate: float, dt: float) -> tuple[Array, Array]:
    """Axial stress [Pa] and damage of every particle, shape [STEPS, particles]."""
    fracture = Fracture([BODY], rules_of(name), drawn(name))
    material = named("basalt", friction=FRICTION[name])
    points = MaterialPoint(BODY.particles, material, strength=True, fracture=fracture)
    stress, damage = [], []
    for _ in range(STEPS):
        points.step(np.diag([rate, 0.0, 0.0]), dt)
        stress.append(points.stress[:, 0, 0])
        damage.append(points["damage_root"] ** 3)
    return np.array(stress), np.array(damage)


def oracle_bar(name: str, rate: float, dt: float) -> tuple[Array, Array]:
    """The same with principal log strains, which add up as all increments are along one axis."""
    flaws, count = drawn(name), BODY.particles
    own = [flaws.strain[first:last] for first, last in zip(flaws.first[:-1], flaws.first[1:], strict=True)]
    total = np.array([len(strains) for strains in own])
    growth = CRACK_SPEED[name] * np.sqrt(LONGITUDINAL / RHO0) / (3.0 * (4.0 / 3.0 * np.pi / count) ** (1.0 / 3.0))
    e, E, root, axial = np.zeros((count, 3)), np.zeros(count), np.zeros(count), np.zeros(count)
    work_strain = rate * dt - 0.5 * (rate * dt) ** 2
    stress, damage = [], []
    for n in range(1, STEPS + 1):
        log_J, D = n * np.log1p(rate * dt), root**3
        e, J = e + np.log1p(rate * dt) * np.array([2.0, -1.0, -1.0]) / 3.0, np.exp(log_J)
        ahead = E + work_strain * axial / RHO0
        P = tillotson(np.full(count, np.expm1(-log_J)), ahead)
        P = np.where(P < 0.0, (1.0 - D) * P, P)
        sqrt_J2 = 2.0 * G / J * np.sqrt(0.5 * (e**2).sum(axis=1))
        e = e * np.minimum(strength_limit(P, ahead, D, FRICTION[name]) / sqrt_J2, 1.0)[:, None]
        s = 2.0 * G / J * e
        before, axial = axial, J * (s[:, 0] - P)
        E = E + 0.5 * work_strain * (before + axial) / RHO0
        strain = (s.max(axis=1) - P) / MODULUS[name]
        active = np.array([(strains < local).sum() for strains, local in zip(own, strain, strict=True)])
        cracks = active if name == "sugiura2018" else np.minimum(active, 1)
        root = np.maximum(root, np.minimum(root + cracks * growth * dt, np.cbrt(active / np.maximum(total, 1))))
        stress.append(axial / J)
        damage.append(root**3)
    return np.array(stress), np.array(damage)


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("name", list(FRICTION))
@pytest.mark.parametrize("rate", [0.1, 1.0, 100.0])
def test_a_bar_breaks_as_an_independent_integration_says(name, rate):
    dt = 2e-3 / rate / STEPS
    stress, damage = engine_bar(name, rate, dt)
    expected_stress, expected_damage = oracle_bar(name, rate, dt)
    mean = expected_stress.mean(axis=1)
    # slow bars break, fast ones outrun their cracks
    assert (mean[-1] < 0.8 * mean.max()) == (rate <= 1.0)
    # round-off of 600 steps
    assert worst(stress, expected_stress, mean.max()) < 1e-12
    assert worst(damage, expected_damage, 1.0) < 1e-13


@pytest.mark.parametrize("rate", Bar().rates)
def test_bars_are_pulled_beyond_their_peak(rate):
    stress = Pull(rate).reference()
    assert stress.argmax() < 0.7 * len(stress)
