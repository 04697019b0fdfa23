"""Checkpoints: all that the next step reads, so that a resumed run equals an uninterrupted one bit for bit."""

from pathlib import Path

import xarray as xr

from engine import PHYSICS_VERSION
from engine.errors import JobError
from engine.job.directory import JobDirectory
from engine.job.storage import is_finite, read_if_sound, write_dataset
from engine.scene.scene import Scene, is_hash_of
from engine.simulation.simulation import Simulation

ORIGIN = ("physics_version", "scene_hash")
"""Attributes that say which runs may go on from a checkpoint."""


def save_checkpoint(job: JobDirectory, simulation: Simulation, progress: dict[str, float]) -> None:
    """Write a checkpoint and keep the one before it.

    Args:
        job: the job directory.
        simulation: what to save, between two calls of `advance`.
        progress: numbers that the caller needs to go on, such as the times of its next outputs [s].

    Raises:
        OSError: the file cannot be written.
    """
    names = simulation.particles.allocated
    state = simulation.particles.read(*names)
    variables = {name: (_dimensions(name, state[name].ndim), state[name]) for name in names}
    origin = {"physics_version": PHYSICS_VERSION, "scene_hash": simulation.scene.hash()}
    dataset = xr.Dataset(variables, attrs={**origin, **simulation.clock_state(), **progress})
    if job.checkpoint.exists():
        job.checkpoint.replace(job.previous_checkpoint)
    write_dataset(job.checkpoint, dataset)


def load_checkpoint(job: JobDirectory, simulation: Simulation) -> dict[str, float] | None:
    """Restore the newest readable checkpoint.

    Args:
        job: the job directory.
        simulation: not started yet; receives the state.

    Returns:
        The `progress` that was saved with it, `None` if there is no checkpoint.

    Raises:
        JobError: the checkpoint belongs to another scene or physics version.
    """
    for path in (job.checkpoint, job.previous_checkpoint):
        dataset = _readable(path)
        if dataset is not None:
            refuse_foreign(dataset, simulation.scene, path)
            if _is_whole(dataset, simulation):
                return _restore(dataset, simulation)
    return None


def refuse_foreign(dataset: xr.Dataset, scene: Scene, path: Path) -> None:
    """Check that a run of this scene, with this version of physics, has written a file.

    Args:
        dataset: the content of the file.
        scene: what is to be run.
        path: the file, for the message.

    Raises:
        JobError: it belongs to another scene or physics version.
    """
    if int(dataset.attrs["physics_version"]) != PHYSICS_VERSION:
        raise JobError(
            f"{path}: written with physics version {dataset.attrs['physics_version']}, this is version "
            f"{PHYSICS_VERSION}; results would mix: run the scene in a new directory"
        )
    if not is_hash_of(dataset.attrs["scene_hash"], scene, path.parent):
        raise JobError(f"{path}: belongs to another scene; run the changed scene in a new directory")


def _dimensions(name: str, ndim: int) -> tuple[str, ...]:
    return ("particle", *(f"{name}_{axis}" for axis in range(1, ndim)))


def _readable(path: Path) -> xr.Dataset | None:
    """Content of a checkpoint that says where it is from; `None` where it is missing or damaged.

    Raises:
        UnavailableError: it cannot be read now; without it the run would begin anew.
    """
    dataset = read_if_sound(path)
    return dataset if dataset is not None and {*ORIGIN} <= {*dataset.attrs} else None


def _is_whole(dataset: xr.Dataset, simulation: Simulation) -> bool:
    """Whether a checkpoint has all that the next step reads, all of it finite."""
    particles = simulation.particles
    whole = {*particles.allocated} <= {*dataset.data_vars} and {*simulation.clock_state()} <= {*dataset.attrs}
    return whole and dataset.sizes["particle"] == particles.count and is_finite(dataset)


def _restore(dataset: xr.Dataset, simulation: Simulation) -> dict[str, float]:
    """Set the state of a simulation and return the progress."""
    numbers = {name: value.item() for name, value in dataset.attrs.items() if name not in ORIGIN}
    clock_state = {name: numbers.pop(name) for name in simulation.clock_state()}
    simulation.restore({name: dataset[name].values for name in simulation.particles.allocated}, clock_state)
    return numbers
