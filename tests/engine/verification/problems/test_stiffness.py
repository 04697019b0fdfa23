"""Comparing profiles of cliffs."""

import numpy as np
import pytest

from engine.verification.problems.stiffness import rms_difference


def test_profiles_are_compared_up_to_the_farther_front():
    long, short = np.array([2.0, 1.0, 0.5, 0.0]), np.array([2.0, 1.3])
    expected = np.sqrt((0.3**2 + 0.5**2) / 3.0)
    assert rms_difference(long, short) == rms_difference(short, long) == pytest.approx(expected)
    assert rms_difference(long, long) == 0.0
