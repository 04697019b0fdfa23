from fractions import Fraction

import numpy as np
import pytest
import taichi as ti

from engine.device.tensors import (
    determinant_increment,
    deviator,
    eigensystem,
    exp_minus_identity,
    expm1,
    half_log,
    largest_eigenvalue,
    log1p,
    norm_squared,
    pack,
    unpack,
)
from tests.helpers.device import Array, compose, evaluate, norm, rotations, traceless, transform, worst

pytestmark = pytest.mark.usefixtures("taichi")

SYMMETRIC = ((3, 3),)
PATTERNS = np.array(
    [
        [1.0, 0.3, -0.8],
        [1.0, 1.0, -0.5],
        [-1.0, -1.0, 0.2],
        [1.0, 1.0, 1.0],
        [1.0, 1.0 + 1e-9, -0.7],
        [1.0, 1.0 - 1e-13, 1.0 + 1e-13],
        [1.0, 0.0, 0.0],
        [1.0, -1.0, 0.0],
        [-0.2, -0.6, -1.0],
        [1.0, 1e-6, -1e-6],
        [0.0, 0.0, 0.0],
    ]
)
"""Eigenvalues: distinct, two or three (nearly) equal, isotropic, sheared, negative definite, of unlike size, zero."""

SIZES = (1e-8, 1e-6, 1e-2, 0.049, 0.051, 0.3, 0.9)
"""Largest eigenvalue; the series ends and the eigenvectors begin at a norm of 0.05."""


def tensors(*sizes: float) -> Array:
    """Tensors of all sizes and patterns and of random eigenvalues, along the axes and turned."""
    generator = np.random.default_rng(1)
    shapes = np.concatenate([PATTERNS, generator.uniform(-1.0, 1.0, (300, 3))])
    values = np.concatenate([size * shapes for size in sizes])
    turned = np.concatenate([compose(values, rotations(generator, len(values))) for _ in range(4)])
    permuted = np.concatenate([values, values[:, [1, 2, 0]], values[:, [2, 0, 1]]])
    return np.concatenate([turned, permuted[:, :, None] * np.eye(3)])


def test_half_log_equals_the_log_of_eigenvalues():
    B = tensors(*SIZES)
    (found,) = evaluate(half_log, B, outputs=SYMMETRIC)
    expected = transform(lambda values: 0.5 * np.log1p(values), B)
    # round-off of some fifty operations; a term of the series too few costs 1e-13
    assert worst(found, expected, norm(expected)) < 1e-14


def test_half_log_holds_for_the_stretch_of_thousandfold_expansion():
    generator = np.random.default_rng(2)
    B = compose(generator.uniform(5.0, 1e6, (2000, 3)), rotations(generator, 2000))
    (found,) = evaluate(half_log, B, outputs=SYMMETRIC)
    expected = transform(lambda values: 0.5 * np.log1p(values), B)
    # the smallest stretch is known to the round-off of the largest: its log to 1e6/5 times 1e-16, of a norm near 10
    assert worst(found, expected, norm(expected)) < 3e-12


def test_exp_minus_identity_equals_expm1_of_eigenvalues():
    S = traceless(tensors(*SIZES))
    (found,) = evaluate(exp_minus_identity, S, outputs=SYMMETRIC)
    expected = transform(np.expm1, S)
    assert worst(found, expected, norm(S)) < 1e-14


def test_exp_undoes_half_log():
    @ti.func
    def there_and_back(S):
        return half_log(exp_minus_identity(2.0 * S))

    S = traceless(tensors(*SIZES))
    (found,) = evaluate(there_and_back, S, outputs=SYMMETRIC)
    assert worst(found, S, norm(S)) < 1e-14


def test_eigensystem_is_orthonormal_and_rebuilds_the_tensor():
    S = tensors(*SIZES, 1e-30, 1e12)
    values, vectors = evaluate(eigensystem, S, outputs=((3,), (3, 3)))
    assert worst(vectors.transpose(0, 2, 1) @ vectors, np.broadcast_to(np.eye(3), S.shape), 1.0) < 1e-14
    assert worst(compose(values, vectors), S, norm(S)) < 1e-14
    assert worst(np.sort(values), np.linalg.eigvalsh(S), norm(S)) < 1e-14


def test_largest_eigenvalue_is_exact_to_round_off():
    S = traceless(tensors(*SIZES))
    (found,) = evaluate(largest_eigenvalue, S)
    assert worst(found, np.linalg.eigvalsh(S)[:, 2], norm(S)) < 1e-14


def test_determinant_increment_equals_exact_arithmetic():
    generator = np.random.default_rng(3)
    H = generator.choice(SIZES, (1000, 1, 1)) * generator.uniform(-1.0, 1.0, (1000, 3, 3))
    (found,) = evaluate(determinant_increment, H)
    expected = np.array([float(exact_determinant(a) - 1) for a in H])
    assert worst(found, expected, norm(H)) < 2e-15


def exact_determinant(H: Array) -> Fraction:
    """det(I + H) without rounding."""
    (a, b, c), (d, e, f), (g, h, i) = [
        [Fraction(x) + (row == column) for column, x in enumerate(line)] for row, line in enumerate(H)
    ]
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def test_log1p_and_expm1_keep_the_digits_of_small_arguments():
    generator = np.random.default_rng(4)
    small = generator.choice([-1.0, 1.0], 4000) * 10.0 ** generator.uniform(-300.0, -0.05, 4000)
    x = np.concatenate([small, generator.uniform(-0.99, 50.0, 4000), [0.0, 1e-16, -1e-16, 1.0, -0.5]])
    (logs,), (exponentials,) = evaluate(log1p, x), evaluate(expm1, x)
    # Goldberg bounds the first by 5 units in the last place, 5.6e-16
    assert worst(logs, np.log1p(x), np.abs(np.log1p(x))) < 1e-15
    assert worst(exponentials, np.expm1(x), np.abs(np.expm1(x))) < 1e-15


def test_packing_keeps_every_component():
    @ti.func
    def there_and_back(S):
        return unpack(pack(S))

    S = tensors(0.3)
    components = S[:, [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]]
    assert np.array_equal(evaluate(pack, S, outputs=((6,),))[0], components)
    assert np.array_equal(evaluate(there_and_back, S, outputs=SYMMETRIC)[0], S)


def test_deviator_and_norm():
    S = tensors(0.3)
    (found,), (squares,) = evaluate(deviator, S, outputs=SYMMETRIC), evaluate(norm_squared, S)
    assert worst(found, traceless(S), norm(S)) < 1e-15
    assert worst(squares, norm(S) ** 2, norm(S) ** 2) < 1e-15
