import pytest

from analysis.results.collect import Collected, collect_with_outcomes
from tests.helpers.fake_campaigns import campaign, grid

COORDS = {"velocity": [100.0, 200.0], "angle": [5.0, 15.0, 25.0]}


@pytest.fixture(scope="package")
def partly_done(tmp_path_factory: pytest.TempPathFactory) -> Collected:
    """Two velocities and three angles: all jobs at 100 m/s are done, and one at 200 m/s."""
    return collect_with_outcomes(campaign(tmp_path_factory.mktemp("partly_done"), COORDS, grid(COORDS), 4))


@pytest.fixture(scope="package")
def nothing_done(tmp_path_factory: pytest.TempPathFactory) -> Collected:
    """The same before any job is done."""
    return collect_with_outcomes(campaign(tmp_path_factory.mktemp("nothing_done"), COORDS, grid(COORDS), 0))
