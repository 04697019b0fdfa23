"""Campaigns of fake jobs with remnants of known shape."""

from pathlib import Path
from typing import Any

import pandas as pd

from campaigns.dotted_keys import nest
from engine.scene.collision import Collision
from tests.helpers.fake_jobs import lattice_ellipsoid, particles, write_campaign, write_job

Coordinates = dict[str, list[Any]]


def collision(**settings: Any) -> Collision:
    """A collision at 200 m/s and 15 deg, unless the settings, by dotted key, say otherwise."""
    return Collision(**nest({"velocity": 200.0, "angle": 15.0, "particles": 200, "end_time": 1000.0, **settings}))


def campaign(directory: Path, coords: Coordinates, cells: list[dict[str, Any]], done: int) -> Path:
    """A campaign of the given cells whose first `done` jobs are done; remnants of later jobs are longer."""
    write_campaign(directory, coords, [(cell, collision(**cell)) for cell in cells])
    for number, cell in enumerate(cells[:done]):
        points, spacing = lattice_ellipsoid(((1.0 + 0.4 * number) * 1e5, 1e5, 8e4), 150)
        write_job(directory / f"jobs/{number}", collision(**cell), particles(points, spacing, time=900.0))
    return directory


def grid(coords: Coordinates) -> list[dict[str, Any]]:
    """All combinations of some coordinates."""
    frame = pd.MultiIndex.from_product(list(coords.values()), names=list(coords)).to_frame(index=False)
    return [{str(key): value for key, value in row.items()} for row in frame.to_dict("records")]
