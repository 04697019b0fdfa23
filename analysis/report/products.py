"""All tables and figures of a campaign, from its jobs as they are now."""

from pathlib import Path

import xarray as xr

from analysis.report.figures import angle, conservation, gallery, maps
from analysis.report.figures.style import Drawing, save
from analysis.report.page import write_report
from analysis.results.collect import collect
from analysis.results.tables import write_shape_table
from campaigns.campaign import KeptCampaign, read_campaign

FIGURES: tuple[Drawing, ...] = (gallery, angle, maps, conservation)
"""Figures of a campaign, in the order of its page."""


def plots(campaign_directory: Path) -> tuple[xr.Dataset, list[Path]]:
    """Collect a campaign; write shape_table.csv, figures/ and report.html; returns the results and the files written.

    Raises:
        SceneError: there is no campaign.json, or it does not describe a campaign.
    """
    results, campaign = collect(campaign_directory), read_campaign(campaign_directory, KeptCampaign)
    directories = {job.id: campaign_directory / job.directory for job in campaign.jobs}
    figures = campaign_directory / "figures"
    figures.mkdir(exist_ok=True)
    table, page = campaign_directory / "shape_table.csv", campaign_directory / "report.html"
    write_shape_table(results, table)
    paths = [figures / f"{drawing.NAME}.png" for drawing in FIGURES]
    for drawing, path in zip(FIGURES, paths, strict=True):
        save(drawing.draw(results, directories), path)
    captioned = [(drawing.CAPTION, path) for drawing, path in zip(FIGURES, paths, strict=True)]
    write_report(campaign, results, directories, captioned, page)
    return results, [table, *paths, page]
