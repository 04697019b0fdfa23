"""The affine velocity of a particle: exact where it can be, and never a source of energy."""

import numpy as np
import pytest
import taichi as ti

from engine.device.backend import mat3
from engine.mpm.affine import affine_velocity
from tests.helpers.device import Array, norm, worst
from tests.helpers.scenes import body, scene, started

pytestmark = pytest.mark.usefixtures("taichi")

Matrices = ti.types.ndarray(dtype=mat3, ndim=1)
Scalars = ti.types.ndarray(dtype=ti.f64, ndim=1)


@ti.kernel
def affine(L: Matrices, dt: ti.f64, j: Scalars, steepest: ti.f64, result: Matrices):
    for p in range(L.shape[0]):
        result[p] = affine_velocity(L[p], dt, j[p], steepest)


def after_step(L: Array, dt: float, j: Array, steepest: float = np.inf) -> Array:
    result = np.zeros_like(L)
    affine(L, dt, j, steepest, result)
    return result


def strain_rate_energy(C: Array, J: Array) -> Array:
    """|sym C|^2 max(J, 1)^(2/3) [1/s^2]."""
    square = np.sum((0.5 * (C + C.transpose(0, 2, 1))) ** 2, axis=(1, 2))
    return np.asarray(square * np.maximum(J, 1.0) ** (2.0 / 3.0))


def exact(C: Array) -> Array:
    """C (I + C)^-1, of a linear flow after unit time."""
    return np.asarray(C @ np.linalg.inv(np.eye(3) + C))


def symmetric(C: Array) -> Array:
    return np.asarray(0.5 * (C + C.transpose(0, 2, 1)))


@pytest.mark.parametrize("size", [1e-6, 1e-2, 0.1, 0.3])
def test_strain_rates_are_those_of_a_linear_flow_and_gain_no_energy_in_dilated_matter(size):
    generator, count = np.random.default_rng(1), 3000
    skew = size * generator.uniform(-1.0, 1.0, (count, 3, 3))
    C, skew = size * generator.uniform(-1.0, 1.0, (count, 3, 3)), 0.5 * (skew - skew.transpose(0, 2, 1))
    C = symmetric(C)
    C[::3] *= np.eye(3)
    j = generator.uniform(-0.8, 5.0, count)
    J = (1.0 + j) * np.linalg.det(np.eye(3) + C)
    found, expected = after_step(C, 1.0, j), exact(C)
    before = strain_rate_energy(C, 1.0 + j)
    limited = (J > 1.0) & (strain_rate_energy(expected, J) > before)
    assert limited.any() and (~limited & (J > 1.0)).any() and (J < 1.0).any()
    assert worst(found[~limited], expected[~limited], size) < 1e-14
    assert strain_rate_energy(found, J)[limited] == pytest.approx(before[limited], rel=1e-10)
    turning = after_step(C + skew, 1.0, j)
    assert worst(turning - symmetric(turning), skew, size) < 1e-15
    assert worst(symmetric(turning) - found, symmetric(exact(C + skew)) - expected, size) < 1e-13


@pytest.mark.parametrize(("rate", "j"), [(0.2, 0.0), (0.2, -0.5), (0.2, 7.0), (-0.2, 7.0), (-0.2, 0.0)])
def test_isotropic_flow_is_exact(rate, j):
    """Velocity H r: H becomes H/(1 + H t)."""
    found = after_step(rate * np.eye(3)[None], 1.0, np.array([j]))
    assert worst(found, rate / (1.0 + rate) * np.eye(3)[None], rate) < 1e-15


def test_isochoric_flow_of_dense_matter_is_exact():
    flow = 0.1 * np.diag([1.0, -1.0, 0.0])[None]
    assert worst(after_step(flow, 1.0, np.zeros(1)), exact(flow), 0.1) < 1e-15


def test_motion_faster_than_the_filter_does_not_run_away_in_dense_matter():
    """|S| stays where it would grow; a slower flow is exact, and so is one that slows down."""
    j, flow = np.full(1, -0.5), 0.2 * np.diag([1.0, 0.5, 0.0])[None]
    assert worst(after_step(-flow, 1.0, j, steepest=0.1), exact(-flow) * norm(flow) / norm(exact(-flow)), 0.2) < 1e-15
    assert worst(after_step(-flow, 1.0, j, steepest=0.3), exact(-flow), 0.2) < 1e-15
    assert worst(after_step(flow, 1.0, j, steepest=0.1), exact(flow), 0.2) < 1e-15


def test_fast_motion_of_dilated_matter_obeys_both_bounds():
    """|S| max(J, 1)^(1/3) where an expansion dilates it, |S| where a collapse compresses it."""
    j, flow = np.full(1, 3.0), np.diag([0.5, 0.5, -0.45])[None]
    for given, J in (
        (flow, 4.0 * np.linalg.det(np.eye(3) + flow[0])),
        (-flow, 4.0 * np.linalg.det(np.eye(3) - flow[0])),
    ):
        found = after_step(given, 1.0, j, steepest=0.1)
        assert norm(found) <= norm(given) * min(1.0, (4.0 / J) ** (1.0 / 3.0)) * (1.0 + 1e-14)


def test_a_thin_sheet_that_closes_does_not_run_away():
    """One layer of rubble has a rate of thinning S that no particles' motion carries: |S| J^(1/3) never grows."""
    rate, J, count = -1e-3, 4.0, 100
    given = scene(body(particles=count), end_time=2.0 / abs(rate), numerics={"cfl": 0.2})
    generator = np.random.default_rng(1)
    x = 50e3 * generator.uniform(-1.0, 1.0, (count, 3)) * [3.0, 3.0, 0.0]
    C = np.tile(np.diag([0.0, 0.0, rate]), (count, 1, 1))
    simulation = started(given, x=x, C=C, v=np.zeros((count, 3)), j=np.full(count, J - 1.0))
    before = simulation.totals()
    while not simulation.finished:
        simulation.advance(simulation.scene.end_time)
        now = simulation.totals()
        assert now.affine_kinetic_energy + now.internal_energy <= J ** (2.0 / 3.0) * before.affine_kinetic_energy
        assert now.total_energy == pytest.approx(before.total_energy, rel=1e-3)
