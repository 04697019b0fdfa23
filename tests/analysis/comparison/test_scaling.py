"""The scaling law against values worked out apart from it, and its limits."""

import math

import pytest

from analysis.comparison.scaling import interacting_share, largest_remnant, mass_left

RADIUS = 50e3
MASS = 4.0 / 3.0 * math.pi * 2700.0 * RADIUS**3


def equal_bodies(velocity: float, angle: float) -> float:
    return largest_remnant((MASS, MASS), (RADIUS, RADIUS), velocity, angle)


@pytest.mark.parametrize(
    ("angle", "expected"),
    [
        (5.0, [2.0, 1.81, 1.57, 1.24, 0.81, 0.28, 0.14, 0.09]),
        (15.0, [2.0, 1.83, 1.62, 1.32, 0.94, 0.48, 0.16, 0.11]),
        (25.0, [2.0, 1.87, 1.71, 1.48, 1.18, 0.82, 0.40, 0.16]),
        (35.0, [2.0, math.nan, math.nan, math.nan, math.nan, math.nan, 0.97, 0.65]),
    ],
)
def test_equal_bodies_of_basalt(angle: float, expected: list[float]) -> None:
    found = [equal_bodies(velocity, angle) for velocity in (50, 100, 150, 200, 250, 300, 350, 400)]
    assert found == pytest.approx(expected, abs=0.0051, nan_ok=True)


def test_the_remnant_of_supercatastrophic_disruption_is_joined_to_that_below() -> None:
    assert mass_left(1.8 * (1.0 - 1e-12)) == pytest.approx(0.1) == mass_left(1.8)


def test_all_of_a_small_projectile_meets_the_target_unless_it_grazes() -> None:
    assert interacting_share((RADIUS, 0.1 * RADIUS), math.sin(math.radians(45.0))) == 1.0
    assert interacting_share((RADIUS, RADIUS), 0.999999) == pytest.approx(0.0, abs=1e-10)


def test_a_small_projectile_takes_little_from_a_target() -> None:
    small = largest_remnant((MASS, 1e-3 * MASS), (RADIUS, 0.1 * RADIUS), 200.0, 0.0)
    assert 0.999 < small < 1.001
