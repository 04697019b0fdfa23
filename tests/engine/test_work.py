"""Energy over whole paths: what stress has done, and gives back."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.engine.device import norm, traceless
from tests.engine.oracle import RHO0, G, log_strain, tillotson
from tests.engine.point import Points

pytestmark = pytest.mark.usefixtures("taichi")


def compressed(end: float, steps: int) -> float:
    """Energy [J/kg] after isotropic deformation from J = 1 to `end`."""
    points = Points(1)
    J = np.linspace(1.0, end, steps + 1)
    for before, after in zip(J[:-1], J[1:], strict=True):
        points.step(((after / before) ** (1.0 / 3.0) - 1.0) * np.eye(3), 1.0)
    return float(points["E"][0])


@pytest.mark.parametrize("end", [0.7, 0.97, 1.05, 0.999])
def test_adiabatic_energy_errs_by_less_than_the_strain_of_a_step(end):
    """The rate belongs to the end of a step, as the grid's work needs it: the error is of first order."""
    path = solve_ivp(lambda J, E: -tillotson(1.0 / J - 1.0, E) / RHO0, (1.0, end), [0.0], rtol=1e-12, atol=1e-12)
    errors = [abs(compressed(end, steps) / path.y[0, -1] - 1.0) for steps in (50, 100, 200)]
    assert errors[0] < abs(np.log(end)) / 50
    assert np.log2(errors[0] / errors[2]) > 2.0


def sheared(steps: int) -> float:
    """Relative error of the energy after isochoric shear by 0.2 along changing axes."""
    generator = np.random.default_rng(1)
    axes = np.linalg.qr(generator.normal(size=(4, 3, 3)))[0]
    points, X = Points(1), np.zeros((1, 3, 3))
    for Q in axes:
        A = (0.1 / steps) * np.outer(Q[:, 0], Q[:, 1])
        for _ in range(steps):
            points.step(A, 1.0)
            X = A + X + A @ X
    expected = G * norm(traceless(log_strain(X)))[0] ** 2 / RHO0
    return abs(float(points["E"][0]) / expected - 1.0)


def test_shear_stores_the_elastic_energy_of_the_log_strain():
    """At constant volume all work is shear: rho0 E = G |dev ln V|^2, whatever the path."""
    errors = [sheared(steps) for steps in (10, 20, 40)]
    # of second order, as an isochoric increment has no trace
    assert errors[2] < 1e-3
    assert np.log2(errors[0] / errors[2]) == pytest.approx(4.0, abs=0.3)


def test_two_hundred_cycles_of_strain_leave_no_energy():
    points = Points(1)
    phase = 2.0 * np.pi * np.arange(50) / 50
    strain = 1e-3 * np.sin(np.append(phase, 2.0 * np.pi))
    peak = 0.0
    for cycle in range(200):
        for before, after in zip(strain[:-1], strain[1:], strict=True):
            points.step(np.diag([(after - before) / (1.0 + before), 0.0, 0.0]), 1.0)
            if cycle == 0:
                peak = max(peak, float(points["E"][0]))
    # what a step errs in one half of a cycle the other half takes back
    assert peak == pytest.approx(0.5 * 1e-6 * 5.6967e10 / RHO0, rel=0.02)
    assert abs(float(points["E"][0])) < 1e-3 * peak
