from dataclasses import dataclass

import pytest
import xarray as xr

from analysis.report.figures.style import Directories
from analysis.results.collect import collect
from tests.helpers.fake_campaigns import campaign, grid, job_directories

COORDS = {"velocity": [100.0, 200.0], "angle": [5.0, 15.0, 25.0]}


@dataclass(frozen=True)
class Collected:
    """The results of a campaign and where its jobs are."""

    results: xr.Dataset
    directories: Directories


@pytest.fixture(scope="package")
def partly_done(tmp_path_factory: pytest.TempPathFactory) -> Collected:
    """Two velocities and three angles: all jobs at 100 m/s are done, and one at 200 m/s."""
    path = campaign(tmp_path_factory.mktemp("partly_done"), COORDS, grid(COORDS), 4)
    return Collected(collect(path), job_directories(path, 4))


@pytest.fixture(scope="package")
def nothing_done(tmp_path_factory: pytest.TempPathFactory) -> Collected:
    """The same before any job is done."""
    return Collected(collect(campaign(tmp_path_factory.mktemp("nothing_done"), COORDS, grid(COORDS), 0)), {})
