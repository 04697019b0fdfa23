"""Job directories as the engine writes them, filled with bodies of known shape."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from engine.job.directory import JobDirectory, Status
from engine.job.storage import write_dataset, write_json
from engine.quantities import HEATS
from engine.scene.collision import Collision
from engine.scene.scene import scene_in

RHO0 = 2700.0


def lattice_ellipsoid(axes: tuple[float, float, float], count: int, seed: int = 0) -> tuple[np.ndarray, float]:
    """About `count` points of a cubic lattice inside an ellipsoid of full `axes` [m], and their spacing [m]."""
    spacing = float((np.pi / 6.0 * np.prod(axes) / count) ** (1.0 / 3.0))
    shift = np.random.default_rng(seed).uniform(0.0, 1.0, 3)
    lines = [np.arange(-np.ceil(axis / spacing), np.ceil(axis / spacing) + 1) for axis in axes]
    points = (np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3) + shift) * spacing
    return points[np.sum((points / (0.5 * np.array(axes))) ** 2, axis=1) <= 1.0], spacing


def particles(position: np.ndarray, spacing: float, velocity: np.ndarray | None = None, **attrs: Any) -> xr.Dataset:
    """A particle file of equal particles at rest, or with the given velocities."""
    count = len(position)
    ones = np.ones(count)
    return xr.Dataset(
        {
            "position": (("particle", "space"), position),
            "velocity": (("particle", "space"), np.zeros((count, 3)) if velocity is None else velocity),
            "mass": ("particle", RHO0 * spacing**3 * ones),
            "J": ("particle", ones),
            "rho": ("particle", RHO0 * ones),
            "damage": ("particle", ones),
            "energy": ("particle", 0.0 * ones),
            "body": ("particle", (position[:, 0] > np.median(position[:, 0])).astype(np.int32)),
        },
        coords={"space": ["x", "y", "z"]},
        attrs={"time": 0.0, "step": 100, "spacing": spacing, "dx": 2 * spacing}
        | {"physics_version": 1, "scene_hash": "none"}
        | attrs,
    )


def history(times: np.ndarray, drift: float = 0.0) -> xr.Dataset:
    """Conserved quantities whose drift grows to `drift` of 4e18 kg, 1e20 kg m/s, 1e25 kg m2/s and 5e21 J."""
    share = np.linspace(0.0, drift, len(times))
    scalar = {
        "mass": 4.0e18 * (1 + share),
        "kinetic_energy": 5.0e21 * (0.2 + 0.8 * np.exp(-np.linspace(0, 4, len(times)))),
        "affine_kinetic_energy": 2.0e20 * np.exp(-np.linspace(0, 3, len(times))),
        "internal_energy": 4.0e21 * (1 - np.exp(-np.linspace(0, 4, len(times)))),
        "gravitational_energy": -2.0e21 - 1e21 * np.linspace(0, 1, len(times)),
        "elastic_energy": 1e17 * np.ones(len(times)),
        "dt": 0.4 * np.ones(len(times)),
    }
    scalar |= {name: np.linspace(0.0, 1.0e20, len(times)) for name in HEATS}
    scalar["total_energy"] = 5.0e21 * (1 + share)
    vector = np.outer(share, [1.0, 0.0, 0.0])
    return xr.Dataset(
        {name: ("time", values) for name, values in scalar.items()}
        | {
            "momentum": (("time", "space"), 1.0e20 * vector),
            "angular_momentum": (("time", "space"), np.array([0.0, 0.0, 1.0e25]) * (1 + share[:, None])),
            "step": ("time", np.arange(len(times))),
        },
        coords={"time": times, "space": ["x", "y", "z"]},
        attrs={"wall_time": 10.0},
    )


def write_job(
    path: Path, collision: Collision, final: xr.Dataset | None, state: str = "done", reason: str = ""
) -> None:
    """A job directory in a state, with a final.nc when given one."""
    path.mkdir(parents=True)
    job = JobDirectory(path)
    write_json(path / "scene.json", collision.scene().model_dump(mode="json"))
    job.write_status(Status(state=state, reason=reason, step=100, wall_time=12.5, cpu_time=20.5))
    write_dataset(job.history, history(np.linspace(-500.0, collision.end_time, 20), 1e-9))
    if final is not None:
        write_dataset(job.final, final.assign_attrs(scene_hash=scene_in(path).hash()))


def write_campaign(
    directory: Path, coords: dict[str, list[Any]], jobs: list[tuple[dict[str, Any], Collision]], **study: Any
) -> None:
    """A campaign.json for jobs at the given indices; the job of each is jobs/<number>."""
    directory.mkdir(parents=True, exist_ok=True)
    entries = [
        {
            "id": f"{number}",
            "directory": f"jobs/{number}",
            "index": index,
            "collision": collision.model_dump(mode="json"),
        }
        for number, (index, collision) in enumerate(jobs)
    ]
    content = {"name": "fake", "physics_version": 1, "study": study, "dims": list(coords), "coords": coords}
    write_json(directory / "campaign.json", content | {"jobs": entries})
