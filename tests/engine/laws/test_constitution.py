import numpy as np
import pytest

from engine.laws.viscosity import Viscosity
from engine.scene.material import named
from engine.scene.scene import ViscosityCoefficients
from engine.verification.material_point import MaterialPoint, unpacked
from tests.helpers.device import Array, norm, rotations, traceless, worst
from tests.helpers.oracle import FRICTION, LONGITUDINAL, RHO0, G, K, log_strain, strength_limit, tillotson

pytestmark = pytest.mark.usefixtures("taichi")


def strained(count: int, size: float, **parts: bool) -> tuple[MaterialPoint, Array]:
    """Particles of random damage after one random step from rest, and their displacement gradients."""
    generator = np.random.default_rng(1)
    X = size * generator.uniform(-1.0, 1.0, (count, 3, 3)) * generator.choice([1e-3, 0.1, 1.0], (count, 1, 1))
    points = MaterialPoint(count, **parts)
    points.particles.write({"damage_root": np.cbrt(generator.choice([0.0, 0.5, 1.0], count))})
    points.step(X, 1.0)
    return points, X


def rest_pressure(j: Array) -> Array:
    """Pressure [Pa] without energy, from det F - 1."""
    mu = -j / (1.0 + j)
    return K * mu + K * mu**2


@pytest.mark.parametrize("strain", [1e-9, 1e-7, 1e-5, -1e-5])
def test_small_uniaxial_strain_meets_the_longitudinal_modulus(strain):
    points = MaterialPoint(1)
    points.step(np.diag([strain, 0.0, 0.0]), 1.0)
    expected = strain * np.diag([LONGITUDINAL, K - 2.0 / 3.0 * G, K - 2.0 / 3.0 * G])[None]
    # the laws bend by a few times the strain
    assert worst(points.stress, expected, LONGITUDINAL * abs(strain)) < 4.0 * abs(strain) + 1e-15


@pytest.mark.parametrize("gamma", [1e-8, 1e-4])
def test_small_simple_shear_meets_the_shear_modulus(gamma):
    points = MaterialPoint(1)
    points.step(gamma * np.eye(3)[[0]].T @ np.eye(3)[[1]], 1.0)
    assert points.stress[0, 0, 1] == pytest.approx(G * gamma, rel=gamma**2 + 1e-15)
    assert points["E"][0] == pytest.approx(0.5 * G * gamma**2 / RHO0, rel=gamma**2 + 1e-14)


@pytest.mark.parametrize(("steps", "size"), [(1, 0.3), (30, 1e-8), (30, 1e-3), (30, 0.03)])
def test_stress_belongs_to_the_deformation_gradient(steps, size):
    generator = np.random.default_rng(2)
    points, X = MaterialPoint(1000), np.zeros((1000, 3, 3))
    for _ in range(steps):
        H = size * generator.uniform(-1.0, 1.0, (1000, 3, 3))
        points.step(10.0 * H, 0.1)
        X = H + X + H @ X
    points.settle()
    ln_V = log_strain(X)
    J = np.exp(np.trace(ln_V, axis1=1, axis2=2))
    s = 2.0 * G * traceless(ln_V) / J[:, None, None]
    P = tillotson(np.expm1(-np.trace(ln_V, axis1=1, axis2=2)), points["E"])
    assert np.abs(traceless(ln_V)).max() > 0.5 * size
    assert worst(points.deviator, s, norm(points.stress)) < 1e-13
    assert worst(points.pressure, P, norm(points.stress)) < 1e-13


def test_stress_turns_with_the_particle():
    generator = np.random.default_rng(3)
    strain = 0.02 * generator.uniform(-1.0, 1.0, (500, 3, 3))
    Q = rotations(generator, 500)
    before = MaterialPoint(500)
    before.step(strain, 1.0)
    after = MaterialPoint(500)
    after.step(strain, 1.0)
    after.step(Q - np.eye(3), 1.0)
    turned = Q @ before.stress @ Q.transpose(0, 2, 1)
    assert worst(after.deviator, traceless(turned), norm(turned)) < 1e-12


def test_yielding_reaches_the_strength_exactly_and_keeps_direction_and_volume():
    yielding, _ = strained(4000, 0.1, strength=True)
    free, _ = strained(4000, 0.1)
    D = yielding["damage_root"] ** 3
    P = rest_pressure(free["j"])
    Y = strength_limit(P, np.zeros(4000), D, FRICTION["sugiura2018"])
    sqrt_J2, unlimited = norm(yielding.deviator) / np.sqrt(2.0), norm(free.deviator) / np.sqrt(2.0)
    assert (unlimited > Y).sum() > 1000 and (unlimited < Y).sum() > 100
    assert worst(sqrt_J2, np.minimum(Y, unlimited), unlimited + np.abs(P)) < 1e-13
    share = np.minimum(Y / unlimited, 1.0)
    assert worst(yielding.deviator, share[:, None, None] * free.deviator, unlimited + np.abs(P)) < 1e-13
    assert np.array_equal(yielding["j"], free["j"])


def test_elastic_points_are_untouched_bit_for_bit():
    yielding, _ = strained(4000, 0.1, strength=True)
    free, _ = strained(4000, 0.1)
    P = rest_pressure(free["j"])
    elastic = norm(free.deviator) / np.sqrt(2.0) < 0.999 * strength_limit(
        P, 0.0, free["damage_root"] ** 3, FRICTION["sugiura2018"]
    )
    assert elastic.sum() > 100
    for name in ("b_minus_I", "tau", "E"):
        assert np.array_equal(yielding[name][elastic], free[name][elastic])
        assert not np.array_equal(yielding[name], free[name])


def test_radial_return_is_idempotent():
    points, _ = strained(4000, 0.1, strength=True)
    # energy alone would change pressure, and with it the strength
    points.particles.write({"E": np.zeros(4000)})
    before = points["b_minus_I"]
    points.settle()
    assert worst(points["b_minus_I"], before, 1.0) < 1e-15


def test_only_pressure_in_tension_falls_with_damage():
    generator = np.random.default_rng(4)
    D = generator.choice([0.0, 1.0, generator.random()], 2000)
    points, X = MaterialPoint(2000), 1e-2 * generator.uniform(-1.0, 1.0, (2000, 3, 3))
    points.particles.write({"damage_root": np.cbrt(D)})
    points.step(X, 1.0)
    J = np.exp(np.trace(log_strain(X), axis1=1, axis2=2))
    P = rest_pressure(J - 1.0)
    assert worst(points.pressure, np.where(P < 0.0, (1.0 - D) * P, P), norm(points.stress) + 1e-3 * K) < 1e-13
    expected = 2.0 * G * traceless(log_strain(X)) / J[:, None, None]
    assert worst(points.deviator, expected, norm(points.stress)) < 1e-13


def test_energy_grows_by_the_work_of_the_mean_of_all_stress():
    generator = np.random.default_rng(5)
    points = MaterialPoint(2000, strength=True, viscosity=Viscosity(ViscosityCoefficients(shear=1e5, bulk=1e5), 1e3))
    for _ in range(3):
        L, dt = 0.01 * generator.uniform(-1.0, 1.0, (2000, 3, 3)), 0.7
        E, tau = points["E"], unpacked(points["tau"])
        points.step(L, dt)
        strain = dt * L - 0.5 * (dt * L) @ (dt * L)
        work = np.einsum("nij,nij->n", 0.5 * (tau + unpacked(points["tau"])), strain) / RHO0
        size = norm(tau) + norm(unpacked(points["tau"]))
        assert worst(points["E"], E + work, np.abs(E) + size * norm(L) * dt / RHO0) < 1e-14


def test_without_shear_there_is_only_pressure():
    points, _ = strained(500, 0.1, shear=False)
    assert not points["b_minus_I"].any() and not points["tau"][:, 3:].any()
    assert np.array_equal(points["tau"][:, 0], points["tau"][:, 1])


def test_the_signal_speed_at_rest_is_that_of_the_stiffest_deformation():
    """sqrt(3 K/rho0) of compression, as long as 3 K > 2 G."""
    basalt = named("basalt")
    for shear in (True, False):
        points = MaterialPoint(1, shear=shear)
        points.settle()
        assert points.signal_speed[0] == pytest.approx(np.sqrt(3.0 * 2.67e10 / 2700.0), rel=1e-12)
    assert points.signal_speed[0] == pytest.approx(basalt.signal_speed, rel=1e-12)
    stiff = basalt.model_copy(update={"shear_modulus": 5e10})
    assert stiff.signal_speed == pytest.approx(np.sqrt(2.0 * 5e10 / 2700.0), rel=1e-12)
