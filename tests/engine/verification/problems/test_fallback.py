"""The exact flight of rubble thrown apart."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.constants import G_NEWTON
from engine.verification.harness import Harness
from engine.verification.problems.fallback import DENSITY, RADIUS, Fallback


@pytest.mark.parametrize("stretch", [1.5, 3.0])
def test_a_shell_turns_at_the_radius_and_the_time_said(stretch):
    flight = Fallback(stretch=stretch)
    pull = 4.0 / 3.0 * np.pi * G_NEWTON * DENSITY * RADIUS**3
    path = solve_ivp(
        lambda t, y: [y[1], -pull / y[0] ** 2],
        (0.0, flight.half_flight),
        [RADIUS, flight.rate * RADIUS],
        rtol=1e-10,
        atol=1e-8,
    )
    assert path.y[0, -1] == pytest.approx(stretch * RADIUS, rel=1e-7)
    assert abs(path.y[1, -1]) < 1e-6 * flight.rate * RADIUS


@pytest.mark.usefixtures("taichi")
def test_dust_turns_where_it_should_and_keeps_its_angular_momentum():
    errors = Fallback(rest=0.2).measure(Harness(), 500)
    assert errors["turned"] == pytest.approx(1.5, rel=0.06), "3.0 % at 1,000 particles, second order in dx"
    assert abs(errors["spin"]) < 1e-3
