"""Affine velocity of a particle that moves freely (engine/physics.md, section 1)."""

import taichi as ti

from engine.device.elementary import power
from engine.device.tensors import determinant_increment, moved, norm_squared, symmetric

SMALLEST = 1e-30
"""Square of a rate [1/s^2] that counts as zero; its cube over that of a real one is finite in single precision."""


@ti.func
def affine_velocity(C, dt, j, steepest):
    """Return the affine velocity [1/s] of matter that has moved freely for dt: sym(C (I + dt C)^-1) + skew(C).

    The skew part keeps angular momentum. The part that strain S = sym(C) sets, S (I + dt S)^-1, is scaled: in dilated
    matter, J > 1, so that |S| max(J, 1)^(1/3) never grows, and where |S| exceeds the steepest gradient, so that |S|
    never grows. Nothing opposes what a particle remembers of itself and the grid does not represent.

    Args:
        C: affine velocity [1/s].
        dt: time of the motion [s].
        j: J - 1 before the motion [-], with J relative to the volume above which matter bears no pressure.
        steepest: gradient that the grid can have and the motion of the bodies can make [1/s].
    """
    S, after, J = symmetric(C), symmetric(moved(C, dt)), 1.0 + j
    dilated, fast = J * (1.0 + determinant_increment(dt * S)), norm_squared(S) > steepest * steepest
    if dilated > 1.0 or fast:
        free, dilation = moved(S, dt), dilated / ti.max(J, 1.0)
        if fast:
            dilation = ti.max(dilation, 1.0)
        growth = norm_squared(free) / ti.max(norm_squared(S), SMALLEST)
        if growth**3 * dilation**2 > 1.0:
            after -= (1.0 - power(dilation, -1.0 / 3.0) / ti.sqrt(growth)) * free
    return after + 0.5 * (C - C.transpose())
