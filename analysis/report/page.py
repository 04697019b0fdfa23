"""A campaign on one page, report.html, that needs no other file: to send, to print, to keep with a paper."""

import json
from base64 import b64encode
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
import xarray as xr
from jinja2 import Environment, PackageLoader

from analysis.report.figures.style import Directories
from analysis.results.tables import as_shown, reasons, shape_table, unresolved
from analysis.results.variables import DRIFTS
from campaigns.campaign import KeptCampaign
from engine.job.directory import JobDirectory
from engine.job.storage import write_text

_page = Environment(
    loader=PackageLoader("analysis.report"), autoescape=True, trim_blocks=True, lstrip_blocks=True
).get_template("report.html")


def write_report(
    campaign: KeptCampaign,
    results: xr.Dataset,
    directories: Directories,
    figures: Sequence[tuple[str, Path]],
    path: Path,
) -> None:
    """Write the page of a campaign.

    Args:
        campaign: its description.
        results: its results.nc.
        directories: its jobs.
        figures: captions and PNG files, in the order of the page.
        path: where the page is written.
    """
    text = _page.render(
        campaign=campaign,
        description=campaign.study.get("description", ""),
        counts=results["state"].to_series().value_counts().to_dict(),
        table=_html(shape_table(results)),
        notes=[*unresolved(results), *reasons(results)],
        figures=[(caption, _embedded(figure)) for caption, figure in figures],
        drifts=[_largest(results[name]) for name in DRIFTS],
        cpu_hours=float(results["cpu_time"].sum()) / 3600.0,
        settings={name: _plain(value) for name, value in results.attrs.items()},
        sessions=_sessions(directories),
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


def _plain(value: Any) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _sessions(directories: Directories) -> dict[str, list[str]]:
    """Every code, package and device that computed a job, each named once."""
    found: dict[str, set[str]] = {}
    for directory in directories.values():
        for session in _sessions_of(JobDirectory(directory)):
            for name, value in _facts(session):
                found.setdefault(name, set()).add(value)
    return {name: sorted(values) for name, values in found.items()}


def _sessions_of(job: JobDirectory) -> list[Any]:
    """A damaged record must not hide the others."""
    try:
        return list(json.loads(job.provenance.read_text(encoding="utf-8"))["sessions"])
    except (OSError, ValueError, KeyError, TypeError):
        return []


def _facts(session: dict[str, Any]) -> Iterator[tuple[str, str]]:
    git = session.get("git", {})
    yield "code", f"{git.get('commit', 'unknown')}{' with changes' if git.get('dirty') else ''}"
    for name in ("python", "arch", "precision", "threads", "platform"):
        yield name, str(session.get(name, "unknown"))
    for package, version in session.get("packages", {}).items():
        yield package, str(version)
