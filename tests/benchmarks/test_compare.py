"""What a comparison of two versions says of their times, and of a commit that does not exist."""

from types import SimpleNamespace
from typing import Any

import pytest

from tests.benchmarks.child import ROOT
from tests.benchmarks.compare import checkout, row


def version(start: float, *laps: float) -> Any:
    times = iter(laps)
    return SimpleNamespace(start=start, lap=lambda: next(times))


@pytest.mark.parametrize(
    ("factor", "verdict"), [(1.2, "slower"), (1.05, "no change"), (0.95, "no change"), (0.8, "faster")]
)
def test_a_change_of_more_than_a_tenth_is_told(factor, verdict):
    """Also where the machine gets slower meanwhile, for both."""
    laps = [0.010, 0.011, 0.030]
    starts, times, ratio, found = row([version(3.0, *laps), version(4.0, *(factor * lap for lap in laps))], 3)
    assert (starts, times) == ("3.0, 4.0", f"11.00, {11.0 * factor:.2f}")
    assert ratio == f"{factor:.2f} ({factor:.2f} to {factor:.2f})" and found == verdict


def test_an_unknown_commit_is_named_and_leaves_nothing():
    with pytest.raises(SystemExit, match="git worktree: "), checkout("nowhere"):
        pass
    assert (ROOT / "engine").is_dir()
