"""All tables and figures of a campaign, from its jobs as they are now."""

from pathlib import Path

import xarray as xr

from analysis.campaign import read_campaign
from analysis.collect import collect
from analysis.figures.angle import shape_versus_angle
from analysis.figures.conservation import conservation
from analysis.figures.gallery import gallery
from analysis.figures.maps import maps
from analysis.figures.style import save
from analysis.tables import write_shape_table


def plots(campaign_directory: Path) -> tuple[xr.Dataset, list[Path]]:
    """Collect a campaign and write shape_table.csv and figures/; returns the results and the files written.

    Raises:
        SceneError: there is no campaign.json, or it does not describe a campaign.
    """
    results = collect(campaign_directory)
    directories = {job.id: campaign_directory / job.directory for job in read_campaign(campaign_directory).jobs}
    figures = campaign_directory / "figures"
    figures.mkdir(exist_ok=True)
    write_shape_table(results, campaign_directory / "shape_table.csv")
    save(shape_versus_angle(results), figures / "shape_vs_angle.png")
    save(maps(results), figures / "maps.png")
    save(gallery(results, directories), figures / "remnants.png")
    save(conservation(results, directories), figures / "conservation.png")
    return results, [campaign_directory / "shape_table.csv", *sorted(figures.glob("*.png"))]
