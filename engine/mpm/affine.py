"""Affine velocity of a particle that moves freely (engine/physics.md, section 1)."""

import taichi as ti

from engine.device.tensors import determinant_increment, identity, norm_squared, symmetric

SMALLEST = 1e-30
"""Square of a rate [1/s^2] that counts as zero; its cube over that of a real one is finite in single precision."""


@ti.func
def affine_velocity(C, dt, j):
    """Return the affine velocity [1/s] of matter that has moved freely for dt: sym(C (I + dt C)^-1) + skew(C).

    The skew part keeps angular momentum. In dilated matter, J > 1, the part that strain S = sym(C) sets,
    S (I + dt S)^-1, is scaled so that |S| max(J, 1)^(1/3) never grows: no stress opposes what a particle of debris
    thinner than a cell remembers of itself.

    Args:
        C: affine velocity [1/s].
        dt: time of the motion [s].
        j: det F - 1 before the motion [-].
    """
    S, moved, J = symmetric(C), symmetric(C @ (identity() + dt * C).inverse()), 1.0 + j
    dilated = J * (1.0 + determinant_increment(dt * S))
    if dilated > 1.0:
        free, dilation = S @ (identity() + dt * S).inverse(), dilated / ti.max(J, 1.0)
        growth = norm_squared(free) / ti.max(norm_squared(S), SMALLEST)
        if growth**3 * dilation**2 > 1.0:
            moved -= (1.0 - dilation ** (-1.0 / 3.0) / ti.sqrt(growth)) * free
    return moved + 0.5 * (C - C.transpose())
