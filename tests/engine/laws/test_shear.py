import numpy as np
import pytest
import taichi as ti
from scipy.spatial.transform import Rotation

from engine.device.backend import mat3
from engine.device.tensors import determinant_increment, deviator, half_log, unpack
from engine.laws.shear import deform
from engine.verification.material_point import unpacked
from tests.helpers.device import Array, compose, norm, rotations, traceless, worst
from tests.helpers.oracle import log_strain

pytestmark = pytest.mark.usefixtures("taichi")

Matrices = ti.types.ndarray(dtype=mat3, ndim=1)
Components = ti.types.ndarray(dtype=ti.types.vector(6, ti.f64), ndim=1)
Scalars = ti.types.ndarray(dtype=ti.f64, ndim=1)


@ti.kernel
def repeat(H: Matrices, steps: ti.i32, B: Components, j: Scalars):
    """The same increment over and over."""
    for p in range(H.shape[0]):
        strain, volume = B[p], j[p]
        for _ in range(steps):
            growth = determinant_increment(H[p])
            strain = deform(strain, H[p], growth)
            volume += (1.0 + volume) * growth
        B[p], j[p] = strain, volume


@ti.kernel
def deviatoric_log(B: Components, result: Matrices):
    for p in range(B.shape[0]):
        result[p] = deviator(half_log(unpack(B[p])))


def packed(S: Array) -> Array:
    return np.ascontiguousarray(S[:, [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]])


def rotation_increment(axis: Array, angle: float) -> Array:
    """R - I by Rodrigues' formula, without the cancellation of 1 - cos."""
    x, y, z = axis
    N = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.sin(angle) * N + 2.0 * np.sin(angle / 2.0) ** 2 * N @ N)


@pytest.mark.parametrize(
    ("angle", "axes"),
    [(1e-6, "any"), (1e-4, "any"), (1e-3, "any"), (1e-2, "coordinate"), (1e-1, "coordinate")],
)
def test_forty_thousand_exact_rotations_leave_a_strain_of_1e_6(angle, axes):
    """About other axes, components of R - I of 1e-2 are rounded by 1e-18, which 40,000 repetitions add up."""
    generator = np.random.default_rng(1)
    count, steps = 60, 40000
    axis = generator.normal(size=(count, 3)) if axes == "any" else np.tile(np.eye(3), (count // 3, 1))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    H = np.array([rotation_increment(n, angle) for n in axis])
    start = compose(1e-6 * generator.uniform(-1.0, 1.0, (count, 3)), rotations(generator, count))
    B, j = packed(start), 1e-6 * generator.uniform(-1.0, 1.0, count)
    volume = j.copy()
    repeat(H, steps, B, j)
    R = Rotation.from_rotvec(steps * angle * axis).as_matrix()
    assert worst(unpacked(B), R @ start @ R.transpose(0, 2, 1), 1.0) < 1e-14
    assert worst(j, volume, 1.0) < 1e-14


@pytest.mark.parametrize("rate", [1e-3, -2e-4])
def test_isotropic_expansion_changes_only_the_volume(rate):
    """Velocity H r from rest: the gradient is H/(1 + H t), J is (1 + H t)^3."""
    B, j = np.zeros((1, 6)), np.zeros(1)
    for n in range(1000):
        repeat(np.eye(3)[None] * rate / (1.0 + n * rate), 1, B, j)
    # a product of 1000 factors
    assert j[0] == pytest.approx((1.0 + 1000 * rate) ** 3 - 1.0, rel=1e-13)
    assert worst(unpacked(B) - B[0, 0] * np.eye(3), np.zeros((1, 3, 3)), 1.0) == 0.0
    # the factor that takes the volume out of B is of third order: 1000 (3 rate)^4
    assert abs(B[0, 0]) < 1e3 * (3.0 * abs(rate)) ** 4 + 1e-13


@pytest.mark.parametrize(("steps", "size"), [(1, 1e-8), (1, 0.1), (50, 1e-8), (50, 1e-3), (50, 0.05)])
def test_log_strain_is_that_of_the_product_of_all_increments(steps, size):
    generator = np.random.default_rng(2)
    count = 1000
    B, j, X = np.zeros((count, 6)), np.zeros(count), np.zeros((count, 3, 3))
    for _ in range(steps):
        H = size * generator.uniform(-1.0, 1.0, (count, 3, 3))
        repeat(H, 1, B, j)
        X = H + X + H @ X
    found = np.zeros((count, 3, 3))
    deviatoric_log(B, found)
    expected = log_strain(X)
    # the round-off of some ten operations a step
    assert worst(found, traceless(expected), norm(expected)) < 1e-15 * (10 + steps)
    volume = np.expm1(np.trace(expected, axis1=1, axis2=2))
    assert worst(j, volume, norm(expected)) < 1e-15 * (10 + steps)


def test_simple_shear_gives_exactly_gamma_and_its_square():
    """F = I + gamma e_x e_y, F F^T - I = gamma (e_x e_y + e_y e_x) + gamma^2 e_x e_x."""
    gamma = np.array([1e-8, 1e-4, 0.3])
    H = np.zeros((3, 3, 3))
    H[:, 0, 1] = gamma
    B, j = np.zeros((3, 6)), np.zeros(3)
    repeat(H, 1, B, j)
    assert np.array_equal(j, np.zeros(3))
    assert worst(B, np.stack([gamma**2, *np.zeros((4, 3)), gamma], axis=1), gamma) < 1e-15


@pytest.mark.parametrize("growth", [-0.9, -0.3, 0.09, 0.11, 1.0, 1.3, 20.0])
def test_a_single_large_step_keeps_a_strain_that_has_a_logarithm(growth):
    """An isotropic step of any size leaves no shear, and one with shear leaves the shear of F F^T."""
    stretch = (1.0 + growth) ** (1.0 / 3.0)
    F = stretch * np.array([[1.1, 0.2, 0.0], [0.0, 1.0 / 1.1, 0.0], [0.0, 0.0, 1.0]])
    H, B, j = np.array([stretch * np.eye(3), F]) - np.eye(3), np.zeros((2, 6)), np.zeros(2)
    repeat(H, 1, B, j)
    found = np.zeros((2, 3, 3))
    deviatoric_log(B, found)
    expected = traceless(log_strain(H))
    assert worst(found, expected, 1.0) < 1e-14
    assert worst(j, np.full(2, growth), 1.0 + growth) < 1e-14
