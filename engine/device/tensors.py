"""Functions of symmetric 3x3 tensors without cancellation at small strains (engine/physics.md, section 10).

S is a symmetric tensor, s its deviator or its six components. Units are those of the argument; strains have none.
"""

import math

import taichi as ti
import taichi.math as tm

from engine.device.backend import mat3, vec3, vec6
from engine.device.elementary import acos, cos, expm1, log1p

SERIES_LIMIT = 0.05
"""Frobenius norm up to which the series below reach round-off; larger tensors go through their eigenvectors."""

ORDER = 9
INVERSE_FACTORIAL = tuple(1.0 / math.factorial(n) for n in range(ORDER + 1))


@ti.func
def pack(S):
    """Return the six components xx, yy, zz, yz, zx, xy of a symmetric tensor."""
    return vec6(S[0, 0], S[1, 1], S[2, 2], S[1, 2], S[0, 2], S[0, 1])


@ti.func
def unpack(s):
    """Return the symmetric tensor of six components."""
    return mat3(s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2])


@ti.func
def identity():
    """Return the unit tensor I."""
    return mat3(1, 0, 0, 0, 1, 0, 0, 0, 1)


@ti.func
def deviator(S):
    """Return S - tr(S) I / 3."""
    return S - S.trace() / 3.0 * identity()


@ti.func
def symmetric(S):
    """Return the symmetric part of S."""
    return 0.5 * (S + S.transpose())


@ti.func
def norm_squared(S):
    """Return S : S."""
    total = S[0, 0] * S[0, 0]
    for i, j in ti.static(ti.ndrange(3, 3)):
        if ti.static(i + j > 0):
            total += S[i, j] * S[i, j]
    return total


@ti.func
def moved(C, dt):
    """Return C (I + dt C)^-1, the gradient of a linear flow C after a time dt.

    By the theorem of Cayley and Hamilton, without an inverse: (C + dt (tr C C - C^2) + dt^2 det C I)/det(I + dt C).
    """
    square, det, trace = C @ C, C.determinant(), C.trace()
    second = 0.5 * (trace * trace - square.trace())
    above = C + dt * (trace * C - square) + (dt * dt * det) * identity()
    return above / (1.0 + dt * (trace + dt * (second + dt * det)))


@ti.func
def determinant_increment(H):
    """Return det(I + H) - 1, without cancellation for small H."""
    minors = (
        H[0, 0] * H[1, 1]
        - H[0, 1] * H[1, 0]
        + H[0, 0] * H[2, 2]
        - H[0, 2] * H[2, 0]
        + H[1, 1] * H[2, 2]
        - H[1, 2] * H[2, 1]
    )
    return H.trace() + minors + H.determinant()


@ti.func
def half_log(b_minus_I):
    """Return ln V = ln(b) / 2 of a left Cauchy-Green tensor b, from b - I."""
    result = mat3(0.0)
    if norm_squared(b_minus_I) <= SERIES_LIMIT**2:
        result = _half_log_series(b_minus_I)
    else:
        values, vectors = eigensystem(b_minus_I)
        logs = vec3(0.5 * log1p(values[0]), 0.5 * log1p(values[1]), 0.5 * log1p(values[2]))
        result = _assemble(logs, vectors)
    return result


@ti.func
def exp_minus_identity(S):
    """Return exp(S) - I of a traceless symmetric tensor."""
    result = mat3(0.0)
    if norm_squared(S) <= SERIES_LIMIT**2:
        result = _expm1_series(S)
    else:
        values, vectors = eigensystem(S)
        result = _assemble(vec3(expm1(values[0]), expm1(values[1]), expm1(values[2])), vectors)
    return result


@ti.func
def _half_log_series(b_minus_I):
    """atanh(Z), Z = (b - I) (b + I)^-1, with powers of Z reduced by its characteristic polynomial."""
    Z = unpack(pack(b_minus_I @ (2.0 * identity() + b_minus_I).inverse()))
    square = unpack(pack(Z @ Z))
    trace, third = Z.trace(), Z.determinant()
    second = 0.5 * (trace * trace - square.trace())
    power = vec3(0.0, 1.0, 0.0)  # Z^n = power . (Z^2, Z, I)
    total = power
    for n in ti.static(range(2, ORDER + 1)):
        power = vec3(power[1] + trace * power[0], power[2] - second * power[0], third * power[0])
        if ti.static(n % 2 == 1):
            total += (1.0 / n) * power
    return total[0] * square + total[1] * Z + total[2] * identity()


@ti.func
def _expm1_series(S):
    square = unpack(pack(S @ S))
    second, third = 0.5 * square.trace(), S.determinant()
    power = vec3(0.0, 1.0, 0.0)  # S^n = power . (S^2, S, I)
    total = power
    for n in ti.static(range(2, ORDER + 1)):
        power = vec3(power[1], power[2] + second * power[0], third * power[0])
        total += ti.static(INVERSE_FACTORIAL[n]) * power
    return total[0] * square + total[1] * S + total[2] * identity()


@ti.func
def _assemble(values, vectors):
    """Sum of values[i] n_i n_i^T over the columns n_i of `vectors`."""
    result = mat3(0.0)
    for i in ti.static(range(3)):
        n = vec3(vectors[0, i], vectors[1, i], vectors[2, i])
        result += values[i] * n.outer_product(n)
    return result


@ti.func
def eigensystem(S):
    """Return eigenvalues (unordered) and eigenvectors (columns) of a symmetric tensor.

    The eigenvalue farthest from the other two has a well-conditioned eigenvector; the others follow from
    the 2x2 problem in the plane normal to it, so equal eigenvalues cost no digits (Eberly 2014).
    """
    s = deviator(S)
    mean = S.trace() / 3.0
    first = isolated_eigenvector(s)
    second = perpendicular(first)
    third = first.cross(second)
    a, b, c = second.dot(s @ second), second.dot(s @ third), third.dot(s @ third)
    half = 0.5 * (a - c)
    radius = ti.sqrt(half * half + b * b)
    cosine, sine = 1.0, 0.0
    if radius > 0.0:
        cosine = ti.sqrt(0.5 * (1.0 + ti.abs(half) / radius))
        sine = 0.5 * b / (radius * cosine)
        if half < 0.0:
            cosine, sine = ti.abs(sine), tm.sign(b) * cosine
            if b == 0.0:
                cosine, sine = 0.0, 1.0
    u, w = cosine * second + sine * third, cosine * third - sine * second
    values = vec3(first.dot(s @ first), 0.5 * (a + c) + radius, 0.5 * (a + c) - radius) + mean
    vectors = ti.Matrix.cols([first, u, w])
    return values, vectors


@ti.func
def largest_eigenvalue(s):
    """Return the largest eigenvalue of a symmetric traceless tensor, to round-off."""
    values, _ = eigensystem(s)
    return values.max()


@ti.func
def isolated_eigenvector(s):
    """Return the unit eigenvector of the eigenvalue of a traceless tensor that is farthest from the other two."""
    scale = ti.sqrt(norm_squared(s) / 6.0)
    result = vec3(1.0, 0.0, 0.0)
    if scale > 0.0:
        q = s / scale
        half_determinant = ti.min(ti.max(0.5 * q.determinant(), -1.0), 1.0)
        root = 2.0 * cos(acos(ti.abs(half_determinant)) / 3.0)
        value = root if half_determinant >= 0.0 else -root
        result = null_vector(q - value * identity())
    return result


@ti.func
def null_vector(M):
    """Return a unit vector along the null space of a symmetric tensor of rank two."""
    r0, r1, r2 = vec3(M[0, 0], M[0, 1], M[0, 2]), vec3(M[1, 0], M[1, 1], M[1, 2]), vec3(M[2, 0], M[2, 1], M[2, 2])
    best = r0.cross(r1)
    for candidate in ti.static((r1.cross(r2), r2.cross(r0))):
        if candidate.norm_sqr() > best.norm_sqr():
            best = candidate
    return best.normalized()


@ti.func
def perpendicular(n):
    """Return a unit vector normal to the unit vector n."""
    result = vec3(-n[2], 0.0, n[0])
    if ti.abs(n[0]) <= ti.abs(n[1]):
        result = vec3(0.0, n[2], -n[1])
    return result.normalized()
