"""All tables and figures of a campaign, from its jobs as they are now."""

from pathlib import Path

import xarray as xr

from analysis.report.figures import angle, conservation, gallery, maps
from analysis.report.figures.style import Drawing, save
from analysis.report.page import write_report
from analysis.results.collect import collect_with_outcomes
from analysis.results.tables import write_shape_table

FIGURES: tuple[Drawing, ...] = (gallery, angle, maps, conservation)
"""Figures of a campaign, in the order of its page."""


def plots(campaign_directory: Path) -> tuple[xr.Dataset, list[Path]]:
    """Collect a campaign; write shape_table.csv, figures/ and report.html; returns the results and the files written.

    Raises:
        SceneError: there is no campaign.json, or it does not describe a campaign.
    """
    found = collect_with_outcomes(campaign_directory)
    figures = campaign_directory / "figures"
    figures.mkdir(exist_ok=True)
    table, page = campaign_directory / "shape_table.csv", campaign_directory / "report.html"
    write_shape_table(found.results, table)
    paths = [figures / f"{drawing.NAME}.png" for drawing in FIGURES]
    for drawing, path in zip(FIGURES, paths, strict=True):
        save(drawing.draw(found.results, found.outcomes), path)
    captioned = [(drawing.CAPTION, path) for drawing, path in zip(FIGURES, paths, strict=True)]
    write_report(found, captioned, page)
    return found.results, [table, *paths, page]
