"""Measures of a run against their bounds."""

from dataclasses import replace

import numpy as np
import pytest

from engine.verification.stability.measures import LARGEST_GROWTH, Measures
from tests.helpers.stability_cases import CALM


def test_what_is_within_all_bounds_breaks_none() -> None:
    assert CALM.broken() == ""
    assert CALM.nearest == pytest.approx(0.5)
    unknown = Measures(0.0, 0.0, 1e-14, np.nan, np.nan, 0.0, 1.0, 1.0, np.inf)
    assert unknown.broken() == "" and unknown.nearest == 0.0


@pytest.mark.parametrize(
    ("bound", "change"),
    [
        ("mass", {"mass_change": 1e-16}),
        ("momentum", {"momentum_drift": 1.01e-14}),
        ("energy", {"energy_growth": 1.01 * LARGEST_GROWTH}),
        ("speed", {"speed": 2001.0}),
        ("rho/rho0", {"compression": 3.01}),
    ],
)
def test_each_bound_can_be_broken(bound: str, change: dict[str, float]) -> None:
    measures = replace(CALM, **change)
    assert measures.broken().startswith(f"{bound} at ") and measures.nearest > 1.0
