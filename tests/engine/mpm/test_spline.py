"""Moments of the quadratic B-spline, which hold at every position of a particle between its nodes."""

import numpy as np
import pytest
import taichi as ti

from engine.device.backend import vec3
from engine.mpm.spline import SECOND_MOMENT, first_moments, spline_weights, sum_of_squares
from tests.helpers.device import Array, evaluate, worst
from tests.helpers.scenes import spline

pytestmark = pytest.mark.usefixtures("taichi")

COUNT = 5000
NODES = np.arange(3.0)


def distances() -> Array:
    """Distances from the lowest node in cells, shape [COUNT, 3], both ends among them."""
    f = np.random.default_rng(1).uniform(0.5, 1.5, (COUNT, 3))
    f[0], f[1] = 0.5, np.nextafter(1.5, 0.0)
    return np.asarray(f)


@ti.func
def weights_along_x(f):
    w = spline_weights(f)
    return vec3(w[0, 0], w[0, 1], w[0, 2])


@ti.func
def moments_along_x(f):
    return first_moments(spline_weights(f)[0, :], f[0])


def test_weights_are_the_splines_values_at_the_nodes():
    f = distances()
    (weights,) = evaluate(weights_along_x, f, outputs=((3,),))
    assert worst(weights, spline(NODES - f[:, :1]), 1.0) < 1e-15


def test_weights_sum_to_one_about_the_particle_with_the_same_second_moment_everywhere():
    f = distances()
    (weights,) = evaluate(weights_along_x, f, outputs=((3,),))
    offset = NODES - f[:, :1]
    assert worst(weights.sum(axis=1), np.ones(COUNT), 1.0) < 1e-15
    assert worst((weights * offset).sum(axis=1), np.zeros(COUNT), 1.0) < 1e-15
    assert worst((weights * offset**2).sum(axis=1), np.full(COUNT, SECOND_MOMENT), 1.0) < 1e-15


def test_first_moments_are_weights_times_distance():
    f = distances()
    (moments,) = evaluate(moments_along_x, f, outputs=((3,),))
    offset = NODES - f[:, :1]
    assert worst(moments, spline(offset) * offset, 1.0) < 1e-15


@ti.func
def squares(f):
    return sum_of_squares(spline_weights(f))


def test_the_sum_of_squares_is_that_of_all_27_weights():
    f = distances()
    (total,) = evaluate(squares, f)
    per_axis = spline(NODES - f[:, :, None])
    full = np.einsum("pi,pj,pk->pijk", *per_axis.transpose(1, 0, 2))
    assert worst(total, (full**2).sum(axis=(1, 2, 3)), 1.0) < 1e-15
