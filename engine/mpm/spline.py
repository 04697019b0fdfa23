"""Quadratic B-spline weights of the three nodes around a particle along every axis (engine/physics.md, section 1)."""

import taichi as ti

from engine.device.backend import Real, vec3


@ti.func
def spline_weights(f):
    """Quadratic B-spline weights of three nodes at distance f, in cells, above the lowest; f in [0.5, 1.5)."""
    return ti.Matrix.cols([0.5 * (1.5 - f) ** 2, 0.75 - (f - 1.0) ** 2, 0.5 * (f - 0.5) ** 2])


@ti.func
def moments(weights, f):
    """Weights along an axis times the distance of their nodes, in cells."""
    return vec3(-f * weights[0], (1.0 - f) * weights[1], (2.0 - f) * weights[2])


@ti.func
def own_share(w):
    """Sum of the squares of all 27 weights: the mean over its nodes of what a particle itself puts there."""
    share = ti.cast(1.0, Real)
    for axis in ti.static(range(3)):
        share *= w[axis, 0] * w[axis, 0] + w[axis, 1] * w[axis, 1] + w[axis, 2] * w[axis, 2]
    return share
