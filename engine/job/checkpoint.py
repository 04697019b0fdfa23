"""Saving everything the next step reads, so that a resumed run equals an uninterrupted one bit for bit."""

from pathlib import Path
from typing import Any

import xarray as xr

from engine import PHYSICS_VERSION
from engine.errors import JobError
from engine.job.directory import JobDirectory
from engine.job.storage import is_finite, read_dataset, write_dataset
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import Particles

CLOCK = {"time": float, "dt": float, "rate": float, "step": int, "moved_out": int}
"""Fields of the clock that outlive a pause."""

EVENTS = ("gravity_due", "gravity_change", "gravity_force", "gravity_torque")
"""Attributes of the simulation that do."""

ATTRIBUTES = {*CLOCK, *EVENTS, "physics_version", "scene_hash"}
"""What no checkpoint lacks beside the particles."""


def save_checkpoint(job: JobDirectory, simulation: Simulation, progress: dict[str, float]) -> None:
    """Write a checkpoint; the one before it is kept.

    Args:
        job: the job directory.
        simulation: what to save, between two calls of `advance`.
        progress: what the caller needs to go on, such as the times of its next outputs.
    """
    state = simulation.particles.read(*simulation.particles.allocated)
    variables = {name: (_dimensions(name, values.ndim), values) for name, values in state.items()}
    clock = {name: kind(getattr(simulation.clock, name)[None]) for name, kind in CLOCK.items()}
    events = {name: float(getattr(simulation, name)) for name in EVENTS}
    attributes: dict[str, Any] = {"physics_version": PHYSICS_VERSION, "scene_hash": simulation.scene.hash()}
    dataset = xr.Dataset(variables, attrs={**attributes, **clock, **events, **progress})
    if job.checkpoint.exists():
        job.checkpoint.replace(job.previous_checkpoint)
    write_dataset(job.checkpoint, dataset)


def load_checkpoint(job: JobDirectory, simulation: Simulation) -> dict[str, float] | None:
    """Restore the newest readable checkpoint; returns the `progress` it was saved with, `None` if there is none.

    Raises:
        JobError: the checkpoint belongs to another scene or physics version.
    """
    for path in (job.checkpoint, job.previous_checkpoint):
        dataset = _readable(path, simulation.particles)
        if dataset is not None:
            refuse_foreign(dataset, simulation.scene, path)
            return _restore(dataset, simulation)
    return None


def refuse_foreign(dataset: xr.Dataset, scene: Scene, path: Path) -> None:
    """Accept only what a run of this scene, with this version of physics, has written.

    Raises:
        JobError: the file at `path` belongs to another scene or physics version.
    """
    if int(dataset.attrs["physics_version"]) != PHYSICS_VERSION:
        raise JobError(
            f"{path}: written with physics version {dataset.attrs['physics_version']}, this is version "
            f"{PHYSICS_VERSION}; results would mix: run the scene in a new directory"
        )
    if dataset.attrs["scene_hash"] != scene.hash():
        raise JobError(f"{path}: belongs to another scene; run the changed scene in a new directory")


def _dimensions(name: str, ndim: int) -> tuple[str, ...]:
    return ("particle", *(f"{name}_{axis}" for axis in range(1, ndim)))


def _readable(path: Path, particles: Particles) -> xr.Dataset | None:
    if not path.exists():
        return None
    try:
        dataset = read_dataset(path)
    except JobError:
        return None
    whole = set(particles.allocated) <= set(dataset.data_vars) and set(dataset.attrs) >= ATTRIBUTES
    return dataset if whole and dataset.sizes["particle"] == particles.count and is_finite(dataset) else None


def _restore(dataset: xr.Dataset, simulation: Simulation) -> dict[str, float]:
    attributes = dict(dataset.attrs)
    simulation.particles.write({name: dataset[name].values for name in simulation.particles.allocated})
    simulation.use_stored_blocks()
    for name, kind in CLOCK.items():
        getattr(simulation.clock, name)[None] = kind(attributes.pop(name))
    for name in EVENTS:
        setattr(simulation, name, float(attributes.pop(name)))
    return {name: float(value) for name, value in attributes.items() if name not in ("physics_version", "scene_hash")}
