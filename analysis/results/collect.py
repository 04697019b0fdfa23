"""Every job of a campaign in one data set, results.nc."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from analysis.remnant.outcome import Outcome, Outcomes, outcome
from analysis.remnant.variables import OUTCOMES
from analysis.results.error_bars import combine
from analysis.results.variables import NONE, TEXTS, Attribute, parameter, parameters, plain
from campaigns.campaign import FILE, KeptCampaign, read_campaign
from campaigns.members import ErrorBars
from engine.errors import SceneError
from engine.job.directory import JobDirectory, JobState
from engine.job.storage import write_dataset
from engine.scene.fields import validate

Column = NDArray[np.float64] | NDArray[np.object_]
"""Numbers or texts of all jobs, shape [job_count]."""

ALWAYS = ("velocity", "angle", "end_time")
"""Parameters that are coordinates even when every job has the same."""

OF_THE_DATA_SET = ("Conventions", "title", "physics_version")
"""Attributes of results.nc that are no settings of its collisions."""


@dataclass(frozen=True)
class Collected:
    """What is known of a campaign.

    Attributes:
        campaign: its description.
        outcomes: of each of its jobs, by job id.
        results: content of results.nc.
    """

    campaign: KeptCampaign
    outcomes: Outcomes
    results: xr.Dataset


def collect(campaign_directory: Path) -> xr.Dataset:
    """Measure every job of a campaign, write results.nc and return it; see `collect_with_outcomes`."""
    return collect_with_outcomes(campaign_directory).results


def collect_with_outcomes(campaign_directory: Path) -> Collected:
    """Measure every job of a campaign and write results.nc into its directory.

    With error bars the jobs are in members.nc, and results.nc contains their means and errors (see error_bars.py).
    Points without an outcome are NaN and have the state of their job. Parameters in which jobs differ are
    coordinates; those that all jobs share are attributes.

    Raises:
        SceneError: there is no campaign.json, it does not describe a campaign or its error bars, or another version
            computed its jobs.
    """
    campaign = read_campaign(campaign_directory, KeptCampaign)
    directories = {job.id: JobDirectory(campaign_directory / job.directory) for job in campaign.jobs}
    outcomes = {name: outcome(directory, campaign.physics_version) for name, directory in directories.items()}
    _require_own_version(outcomes, campaign_directory)
    results = assemble(campaign, [outcomes[job.id] for job in campaign.jobs])
    if campaign.has_error_bars:
        write_dataset(campaign_directory / "members.nc", results)
        results = combine(results, _error_bars(campaign, campaign_directory / FILE))
    write_dataset(campaign_directory / "results.nc", results)
    return Collected(campaign, outcomes, results)


def _error_bars(campaign: KeptCampaign, path: Path) -> ErrorBars:
    """The error bars of the study as campaign.json has them; what an earlier version did not write is the default."""
    table = campaign.study.get("error_bars")
    return validate(ErrorBars, table if isinstance(table, dict) else {}, f"{path}: error_bars")


def _require_own_version(outcomes: Outcomes, directory: Path) -> None:
    """Refuse a campaign of which this version can measure no job: earlier results are never replaced by nothing."""
    foreign = [found for found in outcomes.values() if found.foreign]
    if foreign and not any(found.state is JobState.DONE for found in outcomes.values()):
        raise SceneError(f"{directory}: {foreign[0].reason}; nothing was written")


def assemble(campaign: KeptCampaign, outcomes: list[Outcome]) -> xr.Dataset:
    """The data set of a campaign from the outcome of each of its jobs, in their order."""
    shared, differing = _parameters(campaign)
    return xr.Dataset(
        _numbers(campaign, outcomes) | _texts(campaign, outcomes),
        coords=_axes(campaign) | {name: _parameter(campaign, name) for name in differing},
        attrs={
            "Conventions": "CF-1.11",
            "title": f"Outcomes of the collisions of the campaign {campaign.name}",
            "physics_version": campaign.physics_version,
            **{name: value for name, value in shared.items() if name not in (*campaign.dims, *differing)},
        },
    )


def _parameters(campaign: KeptCampaign) -> tuple[dict[str, Attribute], list[str]]:
    """Parameters all jobs share, and the names of those that are coordinates beside the axes."""
    tables = [parameters(job) for job in campaign.jobs]
    names = dict.fromkeys(name for table in tables for name in table)
    columns = {name: _values(tables, name) for name in names if not any(key.startswith(f"{name}.") for key in names)}
    shared = {name: next(iter(values)) for name, values in columns.items() if len(values) == 1}
    differing = [name for name in columns if name not in shared]
    return shared, [name for name in dict.fromkeys((*ALWAYS, *differing)) if name not in campaign.dims]


def _values(tables: list[dict[str, Attribute]], name: str) -> set[Attribute]:
    """Different values of a parameter; constants of a material count only where a job has that material."""
    if name.startswith("materials."):
        return {table[name] for table in tables if name in table}
    return {table.get(name, NONE) for table in tables}


def _axes(campaign: KeptCampaign) -> dict[str, xr.DataArray]:
    columns = {dim: _column([plain(value) for value in campaign.coords[dim]]) for dim in campaign.dims}
    return {dim: xr.DataArray(column, dims=dim, attrs=_attributes(dim)) for dim, column in columns.items()}


def _parameter(campaign: KeptCampaign, name: str) -> xr.DataArray:
    column = _column([parameters(job).get(name, NONE) for job in campaign.jobs])
    return _grid(campaign, column, np.nan if column.dtype.kind == "f" else NONE, _attributes(name))


def _numbers(campaign: KeptCampaign, outcomes: list[Outcome]) -> dict[str, xr.DataArray]:
    return {
        name: _grid(
            campaign, _column([found.numbers.get(name, NONE) for found in outcomes]), np.nan, variable.attributes()
        )
        for name, variable in OUTCOMES.items()
    }


def _texts(campaign: KeptCampaign, outcomes: list[Outcome]) -> dict[str, xr.DataArray]:
    texts = [
        {"state": found.state.value, "reason": found.reason, "job": job.id}
        for job, found in zip(campaign.jobs, outcomes, strict=True)
    ]
    empty = {"state": JobState.MISSING.value, "reason": "", "job": ""}
    return {
        name: _grid(
            campaign, np.array([text[name] for text in texts], dtype=object), empty[name], variable.attributes()
        )
        for name, variable in TEXTS.items()
    }


def _grid(campaign: KeptCampaign, column: Column, empty: float | str, attributes: dict[str, str]) -> xr.DataArray:
    """The values of all jobs, each at the point of its job; `empty` where there is no job."""
    values = np.full(campaign.shape, empty, dtype=column.dtype)
    for job, value in zip(campaign.jobs, column, strict=True):
        values[campaign.position(job)] = value
    return xr.DataArray(values, dims=campaign.dims, attrs=attributes)


def _column(values: Sequence[Attribute]) -> Column:
    """Numbers as f64 with NaN for none; anything with other texts in it as texts."""
    if any(isinstance(value, str) and value != NONE for value in values):
        return np.array([str(value) for value in values], dtype=object)
    return np.array([np.nan if value == NONE else value for value in values], dtype=np.float64)


def _attributes(name: str) -> dict[str, str]:
    return parameter(name).attributes()
