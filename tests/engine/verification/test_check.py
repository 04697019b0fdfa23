"""Comparisons pass as their error says."""

import numpy as np

from engine.verification.check import Check


def test_a_check_that_is_not_a_number_fails_unless_it_is_only_shown():
    assert not Check.absolute("x", "m", np.nan, 0.0, 1.0).passed
    assert Check.absolute("x", "m", np.nan, 0.0, np.inf).passed


def test_a_relative_error_is_over_the_expected_value_or_a_given_scale():
    assert Check.relative("x", "m", 1.01, 1.0, 0.02).passed
    assert not Check.relative("x", "m", 1.03, 1.0, 0.02).passed
    assert Check.relative("x", "m", 1.03, 1.0, 0.02, scale=2.0).passed


def test_an_absolute_error_has_no_sign():
    assert Check.absolute("x", "m", 1.0, 1.5, 0.5).passed and not Check.absolute("x", "m", 1.0, 1.6, 0.5).passed
