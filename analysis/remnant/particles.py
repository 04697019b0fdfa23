"""The particles of a job at one time, read from final.nc or a snapshot."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from engine.errors import JobError, RunFault, UnavailableError
from engine.job.directory import JobDirectory
from engine.job.storage import is_finite, read_attributes, read_dataset
from engine.quantities import PARTICLES

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MEASURED = ("position", "velocity", "mass", "J", "rho", "damage")
"""Variables of a particle file of which outcomes are made, beside the body."""


@dataclass(frozen=True)
class Particles:
    """State of all particles, or of a selection of them.

    Attributes:
        position: [m], shape [particle_count, 3].
        velocity: [m/s], shape [particle_count, 3].
        mass: [kg], shape [particle_count].
        J: det F = rho0/rho [-], shape [particle_count].
        rho: density [kg/m3], shape [particle_count].
        damage: [-], shape [particle_count].
        packing: J_c, the J above which broken rock bears no pressure [-], shape [particle_count].
        body: index of the body in the scene, shape [particle_count].
        spacing: particle spacing h [m].
        time: simulated time after point-mass contact [s].
        contact_time: when bodies touched, on the same clock [s]; NaN if they have not.
        physics_version: of the engine that made them.
        scene_hash: of the scene that they are of.
    """

    position: Array
    velocity: Array
    mass: Array
    J: Array
    rho: Array
    damage: Array
    packing: Array
    body: Integers
    spacing: float
    time: float
    contact_time: float
    physics_version: int
    scene_hash: str

    def select(self, chosen: NDArray[np.bool_]) -> "Particles":
        """The particles where `chosen`, shape [particle_count], holds."""
        return replace(self, **{name: getattr(self, name)[chosen] for name in (*MEASURED, "packing", "body")})


def read_particles(path: Path) -> Particles:
    """The particles in a final.nc or snapshot file.

    Raises:
        JobError: the file is missing, damaged, holds no particles, or lacks a variable.
        RunFault: a value is not finite.
    """
    dataset = read_dataset(path)
    try:
        particles = _particles(dataset)
    except (KeyError, ValueError, TypeError) as error:
        raise JobError(f"{path}: not a file of particles: {error}") from error
    if not is_finite(dataset):
        raise RunFault(f"{path}: holds values that are not finite")
    return particles


def _particles(dataset: xr.Dataset) -> Particles:
    if not dataset.sizes["particle"]:
        raise ValueError("it holds no particle")
    return Particles(
        **{name: _values(dataset, name) for name in MEASURED},
        packing=_values(dataset, "packing") if "packing" in dataset else np.ones(dataset.sizes["particle"]),
        body=_values(dataset, "body").astype(np.int64),
        spacing=float(dataset.attrs["spacing"]),
        time=float(dataset.attrs["time"]),
        contact_time=float(dataset.attrs.get("contact_time", np.nan)),
        physics_version=int(dataset.attrs["physics_version"]),
        scene_hash=str(dataset.attrs["scene_hash"]),
    )


def _values(dataset: xr.Dataset, name: str) -> Array:
    return dataset[name].transpose(*PARTICLES[name].dims("particle")).to_numpy().astype(np.float64)


def snapshots(job: JobDirectory) -> list[tuple[float, Path]]:
    """Time [s] and file of every snapshot, in order of time.

    Raises:
        UnavailableError: the system refuses to read a snapshot now.
        JobError: one is damaged.
    """
    return sorted((_time(path), path) for path in job.snapshots.glob("*.nc"))


def _time(path: Path) -> float:
    try:
        return float(read_attributes(path)["time"])
    except UnavailableError:
        raise
    except (JobError, KeyError, ValueError) as error:
        raise JobError(f"{path}: not a snapshot: {error}") from error
