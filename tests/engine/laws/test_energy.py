"""Energy over whole paths: what stress has done, and gives back."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.verification.material_point import MaterialPoint
from tests.helpers.device import norm, traceless
from tests.helpers.oracle import RHO0, G, log_strain, tillotson

pytestmark = pytest.mark.usefixtures("taichi")


def test_adiabatic_energy_errs_by_less_than_the_strain_of_a_step():
    """The rate belongs to the end of a step, as the grid's work needs it: the error is of first order."""
    ends, steps = np.array([0.7, 0.97, 1.05, 0.999]), np.array([50, 100, 200])
    J_end, count = (values.ravel() for values in np.meshgrid(ends, steps, indexing="ij"))
    points = MaterialPoint(12)
    for n in range(200):
        J = 1.0 + (J_end - 1.0) * np.minimum(np.array([n, n + 1])[:, None] / count, 1.0)
        points.step(((J[1] / J[0]) ** (1.0 / 3.0) - 1.0)[:, None, None] * np.eye(3), 1.0)
    for end, found in zip(ends, points["E"].reshape(4, 3), strict=True):
        path = solve_ivp(lambda J, E: -tillotson(1.0 / J - 1.0, E) / RHO0, (1.0, end), [0.0], rtol=1e-12, atol=1e-12)
        errors = np.abs(found / path.y[0, -1] - 1.0)
        assert errors[0] < abs(np.log(end)) / 50
        assert (np.log2(errors[:-1] / errors[1:]) > 1.0).all()


def test_shear_stores_the_elastic_energy_of_the_log_strain():
    """At constant volume all work is shear: rho0 E = G |dev ln V|^2, whatever the path."""
    steps = np.array([10, 20, 40])
    points, X = MaterialPoint(3), np.zeros((3, 3, 3))
    for Q in np.linalg.qr(np.random.default_rng(1).normal(size=(4, 3, 3)))[0]:
        for n in range(40):
            size = np.where(n < steps, 0.1 / steps, 0.0)
            H = size[:, None, None] * np.outer(Q[:, 0], Q[:, 1])
            points.step(H, 1.0)
            X = H + X + H @ X
    errors = np.abs(points["E"] * RHO0 / (G * norm(traceless(log_strain(X))) ** 2) - 1.0)
    # of second order, as an isochoric increment has no trace
    assert errors[2] < 1e-3
    assert np.log2(errors[0] / errors[2]) == pytest.approx(4.0, abs=0.3)


def test_two_hundred_cycles_of_strain_leave_no_energy():
    points = MaterialPoint(1)
    phase = 2.0 * np.pi * np.arange(50) / 50
    strain = 1e-3 * np.sin(np.append(phase, 2.0 * np.pi))
    peak = 0.0
    for cycle in range(200):
        for before, after in pairwise(strain):
            points.step(np.diag([(after - before) / (1.0 + before), 0.0, 0.0]), 1.0)
            if cycle == 0:
                peak = max(peak, float(points["E"][0]))
    # what a step errs in one half of a cycle the other half takes back
    assert peak == pytest.approx(0.5 * 1e-6 * 5.6967e10 / RHO0, rel=0.02)
    assert abs(float(points["E"][0])) < 1e-3 * peak
