"""A campaign on one page, report.html, that needs no other file: to send, to print, to keep with a paper."""

from base64 import b64encode
from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import xarray as xr
from jinja2 import Environment, PackageLoader
from pydantic import BaseModel, ConfigDict, ValidationError

from analysis.remnant.outcome import Outcomes
from analysis.remnant.variables import DRIFTS
from analysis.results.collect import OF_THE_DATA_SET, Collected
from analysis.results.tables import as_shown, reasons, shape_table, unresolved
from engine.job.directory import JobDirectory
from engine.job.storage import write_text

_page = Environment(
    loader=PackageLoader("analysis.report"), autoescape=True, trim_blocks=True, lstrip_blocks=True
).get_template("report.html")


class Code(BaseModel):
    """The code of a session.

    Attributes:
        commit: of its repository.
        dirty: whether it was changed since.
    """

    commit: str = "unknown"
    dirty: bool = False


class SessionRecord(BaseModel):
    """What provenance.json tells of one session of a job.

    Attributes:
        git: its code.
        python, arch, precision, threads, platform: in which it ran.
        packages: their versions.
    """

    model_config = ConfigDict(coerce_numbers_to_str=True)

    git: Code = Code()
    python: str = "unknown"
    arch: str = "unknown"
    precision: str = "unknown"
    threads: str = "unknown"
    platform: str = "unknown"
    packages: dict[str, str] = {}

    def facts(self) -> dict[str, str]:
        """Code, interpreter, device and packages, each with its name."""
        code = f"{self.git.commit}{' with changes' if self.git.dirty else ''}"
        return {"code": code} | self.model_dump(exclude={"git", "packages"}) | self.packages


class Provenance(BaseModel):
    """Content of provenance.json.

    Attributes:
        sessions: of one job, oldest first.
    """

    sessions: list[SessionRecord]


def write_report(found: Collected, figures: Sequence[tuple[str, Path]], path: Path) -> None:
    """Write the page of a campaign.

    Args:
        found: the campaign, the outcomes of its jobs, and its results.
        figures: captions and PNG files, in the order of the page.
        path: where the page is written.
    """
    results = found.results
    text = _page.render(
        campaign=found.campaign,
        description=found.campaign.study.get("description", ""),
        counts=results["state"].to_series().value_counts().to_dict(),
        table=_html(shape_table(results)),
        notes=[*unresolved(results), *reasons(results)],
        figures=[(caption, _embedded(figure)) for caption, figure in figures],
        drifts=[_largest(results[name]) for name in DRIFTS],
        cpu_hours=float(results["cpu_time"].sum()) / 3600.0,
        settings={name: _plain(value) for name, value in results.attrs.items() if name not in OF_THE_DATA_SET},
        sessions=_sessions(found.outcomes),
    )
    write_text(path, text)


def _embedded(figure: Path) -> str:
    """A figure as the address of its own content."""
    return f"data:image/png;base64,{b64encode(figure.read_bytes()).decode()}"


def _html(table: pd.DataFrame) -> str:
    """The table as on a terminal; pandas escapes its texts."""
    shown, formatters = as_shown(table)
    return shown.to_html(index=False, formatters=formatters, na_rep="-", border=0)


def _largest(drift: xr.DataArray) -> tuple[str, str]:
    """What drifts, and the largest drift of all jobs."""
    return str(drift.attrs["long_name"]), f"{float(abs(drift).max()):.2g}"


def _plain(value: object) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _sessions(outcomes: Outcomes) -> dict[str, list[str]]:
    """Every code, package and device that computed a job, each named once."""
    found: dict[str, set[str]] = {}
    for outcome in outcomes.values():
        for session in _sessions_of(outcome.job):
            for name, value in session.facts().items():
                found.setdefault(name, set()).add(value)
    return {name: sorted(values) for name, values in found.items()}


def _sessions_of(job: JobDirectory) -> list[SessionRecord]:
    """The sessions of a job; none when the record is missing or damaged, so that the others are still shown."""
    try:
        return Provenance.model_validate_json(job.provenance.read_bytes()).sessions
    except (OSError, ValidationError):
        return []
