"""The exact collapse."""

import pytest

from engine.verification.problems.collapse import Fall


def test_the_exact_collapse_takes_1278_seconds():
    assert Fall(100).collapse_time == pytest.approx(1278.0, abs=0.5)
