"""Quadratic B-spline weights of the three nodes around a particle along every axis (engine/physics.md, section 1)."""

import taichi as ti

from engine.device.backend import Real, vec3

WIDTH = 3
"""Nodes of a particle along an axis."""

REACH = 1.5
"""Distance [cells] at which the spline of a node ends."""

SECOND_MOMENT = 0.25
"""Second moment of the weights along an axis, sum w_i (x_i - x)^2, in units of dx^2; the same at every position."""


@ti.func
def spline_weights(f):
    """Return the weights of the three nodes of every axis.

    Args:
        f: distance of the particle above its lowest node, in cells, in [0.5, 1.5), shape [3].
    """
    return ti.Matrix.cols([0.5 * (1.5 - f) ** 2, 0.75 - (f - 1.0) ** 2, 0.5 * (f - 0.5) ** 2])


@ti.func
def weight_of(w, node):
    """Return the weight of one of the 27 nodes, by its coordinates above the lowest one, of the weights of all axes."""
    result = ti.cast(1.0, Real)
    for axis, i in ti.static(ti.ndrange(3, WIDTH)):
        if node[axis] == i:
            result *= w[axis, i]
    return result


@ti.func
def first_moments(weights, f):
    """Return the weights along an axis times the distance of their nodes from the particle, in cells."""
    return vec3(-f * weights[0], (1.0 - f) * weights[1], (2.0 - f) * weights[2])


@ti.func
def sum_of_squares(w):
    """Return the sum of w_i^2 over all 27 nodes."""
    total = ti.cast(1.0, Real)
    for axis in ti.static(range(3)):
        total *= w[axis, 0] * w[axis, 0] + w[axis, 1] * w[axis, 1] + w[axis, 2] * w[axis, 2]
    return total
