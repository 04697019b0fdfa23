"""All tables and figures of a campaign, from its jobs as they are now."""

from pathlib import Path

import xarray as xr

from analysis.campaign import read_campaign
from analysis.report.figures.angle import shape_versus_angle
from analysis.report.figures.conservation import conservation
from analysis.report.figures.gallery import gallery
from analysis.report.figures.maps import maps
from analysis.report.figures.style import save
from analysis.report.page import write_report
from analysis.results.collect import collect
from analysis.results.tables import write_shape_table


def plots(campaign_directory: Path) -> tuple[xr.Dataset, list[Path]]:
    """Collect a campaign; write shape_table.csv, figures/ and report.html; returns the results and the files written.

    Raises:
        SceneError: there is no campaign.json, or it does not describe a campaign.
    """
    results, campaign = collect(campaign_directory), read_campaign(campaign_directory)
    directories = {job.id: campaign_directory / job.directory for job in campaign.jobs}
    figures = campaign_directory / "figures"
    figures.mkdir(exist_ok=True)
    table, page = campaign_directory / "shape_table.csv", campaign_directory / "report.html"
    write_shape_table(results, table)
    drawn = {
        "remnants": gallery(results, directories),
        "shape_vs_angle": shape_versus_angle(results),
        "maps": maps(results),
        "conservation": conservation(results, directories),
    }
    paths = [figures / f"{name}.png" for name in drawn]
    for figure, path in zip(drawn.values(), paths, strict=True):
        save(figure, path)
    write_report(campaign, results, directories, paths, page)
    return results, [table, *paths, page]
