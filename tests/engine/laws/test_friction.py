"""Laws of friction against the friction angle of soil mechanics, on every stress that they allow."""

import numpy as np
import pytest

from engine.laws.friction import FRICTION_LAWS, lode_parameter
from engine.scene.material import named
from engine.verification.material_point import MaterialPoint
from engine.verification.problems.friction_angle import in_compression, in_extension
from tests.helpers.device import Array, evaluate

pytestmark = pytest.mark.usefixtures("taichi")

ANGLES = np.deg2rad([0.0, 1.0, 15.0, 30.0, 40.0, 60.0, 85.0])
LAWS = list(FRICTION_LAWS)
CONES = ["mohr-coulomb", "matsuoka-nakai"]
"""Laws that have a friction angle."""


def directions(count: int) -> Array:
    """Deviators of any size and orientation, positive in tension, the axes and pure shear among them."""
    generator = np.random.default_rng(1)
    principal = generator.normal(size=(count, 3))
    principal[:3] = np.array([[1.0, 1.0, -2.0], [-1.0, -1.0, 2.0], [1.0, 0.0, -1.0]])[:count]
    principal -= principal.mean(axis=1, keepdims=True)
    principal *= 10.0 ** generator.uniform(-9.0, 9.0, (count, 1))
    turns = np.linalg.qr(generator.normal(size=(count, 3, 3)))[0]
    return np.asarray(np.einsum("pij,pj,pkj->pik", turns, principal, turns))


def coefficient(name: str, mu: Array | float, s: Array) -> Array:
    return evaluate(FRICTION_LAWS[name]().coefficient, np.broadcast_to(mu, len(s)).astype(float), s)[0]


def at_the_limit(name: str, mu: float, s: Array) -> Array:
    """Principal stresses over P at the limit, positive in compression, largest first."""
    r = coefficient(name, mu, s)
    principal = -np.linalg.eigvalsh(s)
    unit = principal / np.sqrt(0.5 * (principal**2).sum(axis=1, keepdims=True))
    return np.asarray(-np.sort(-(1.0 + r[:, None] * unit), axis=1))


def test_the_lode_parameter_is_one_in_compression_and_minus_one_in_extension():
    (found,) = evaluate(lode_parameter, directions(3))
    np.testing.assert_allclose(found, [1.0, -1.0, 0.0], atol=1e-7)
    assert evaluate(lode_parameter, np.zeros((1, 3, 3)))[0] == 1.0


@pytest.mark.parametrize("name", LAWS)
def test_the_coefficient_is_that_of_triaxial_compression(name):
    for mu in map(in_compression, ANGLES):
        assert coefficient(name, mu, directions(1))[0] == pytest.approx(mu, rel=1e-7, abs=1e-15)


@pytest.mark.parametrize("name", CONES)
def test_cones_with_a_friction_angle_have_it_in_extension_too(name):
    for phi in ANGLES:
        found = coefficient(name, in_compression(phi), directions(2)[1:])[0]
        assert found == pytest.approx(in_extension(phi), rel=1e-6, abs=1e-15)


def test_mohr_coulomb_is_the_friction_angle_on_the_weakest_plane():
    """sin(phi) = (s1 - s3)/(s1 + s3), whatever s2."""
    for phi in ANGLES:
        s1, _, s3 = at_the_limit("mohr-coulomb", in_compression(phi), directions(2000)).T
        np.testing.assert_allclose((s1 - s3) / (s1 + s3), np.sin(phi), atol=1e-11)


def test_matsuoka_nakai_keeps_the_ratio_of_invariants():
    """I1 I2/I3 = 9 + 8 tan^2(phi)."""
    for phi in ANGLES[:-1]:
        s1, s2, s3 = at_the_limit("matsuoka-nakai", in_compression(phi), directions(2000)).T
        ratio = (s1 + s2 + s3) * (s1 * s2 + s2 * s3 + s3 * s1) / (s1 * s2 * s3)
        np.testing.assert_allclose(ratio, 9.0 + 8.0 * np.tan(phi) ** 2, rtol=1e-11)


@pytest.mark.parametrize("name", CONES)
def test_cohesionless_rock_bears_no_tension(name):
    for phi in ANGLES:
        assert at_the_limit(name, in_compression(phi), directions(2000)).min() > -1e-9


def test_the_circular_cone_of_forty_degrees_bears_tension():
    """What the laws above are for."""
    assert at_the_limit("drucker-prager", in_compression(np.deg2rad(40.0)), directions(2000)).min() < -0.08


@pytest.mark.parametrize("name", LAWS)
def test_damaged_rock_returns_to_the_limit_of_its_law_and_stays_there(name):
    """Its volume and the direction of its shear stay; the work of friction is never negative."""
    material = named("basalt", friction_law=name, friction=0.8)
    L = directions(200)
    L /= np.sqrt((L**2).sum(axis=(1, 2)))[:, None, None]
    point = MaterialPoint(200, material, strength=True)
    point.particles.write({"damage_root": np.ones(200)})
    point.step(-4e-3 * np.eye(3), 1.0)
    energy = point["E"]
    for _ in range(20):
        point.step(1e-3 * L, 1.0)
        assert (point["E"] + point["half_step_work"] >= energy * (1.0 - 1e-12)).all()
        energy = point["E"]
    P, s = point.pressure, point.deviator
    assert (P > 0.0).all()
    np.testing.assert_allclose(np.sqrt(0.5 * (s**2).sum(axis=(1, 2))) / P, coefficient(name, 0.8, s), rtol=1e-7)
    np.testing.assert_allclose(point.J, (1.0 - 4e-3) ** 3, rtol=1e-4)
    for _ in range(2):
        point.settle()
    np.testing.assert_allclose(point.deviator, s, atol=1e-9 * P.max())
