"""From a study to its jobs."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from campaigns.alias import alias, job_id
from campaigns.campaign import Campaign, Job
from campaigns.keys import flatten, ordered, scalar_keys, value_at
from campaigns.study import Study
from engine import PHYSICS_VERSION
from engine.collision import Collision
from engine.errors import SceneError
from engine.scene import Scene
from engine.validation import suggestion


def expand(study: Study, source: str) -> Campaign:
    """All jobs of a study, each with its scene built once to see that it can be.

    Args:
        study: axes or cases over shared settings.
        source: the file that errors name.

    Raises:
        SceneError: a key or value is wrong, or two jobs would be the same.
    """
    if (study.axes is None) == (study.cases is None):
        raise SceneError(f"{source}: give either [axes], for all combinations of values, or [[cases]], one table a job")
    study.shared_settings(f"{source}: collision")
    jobs = _grid_jobs(study, source) if study.axes is not None else _case_jobs(study, source)
    _refuse_equal_jobs(jobs, source)
    dims = tuple(jobs[0].index)
    coords = {dim: tuple(dict.fromkeys(job.index[dim] for job in jobs)) for dim in dims}
    return Campaign(
        name=study.name, physics_version=PHYSICS_VERSION, study=study, dims=dims, coords=coords, jobs=tuple(jobs)
    )


def scene_of(collision: Collision, source: str) -> Scene:
    """The scene of a collision.

    Raises:
        SceneError: no orbit leads to this collision, or its numbers leave the range of floating point.
    """
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            return collision.scene()
    except (ValueError, ArithmeticError, IndexError) as error:
        reason = " ".join(str(error).split())
        raise SceneError(f"{source}: no scene can be built from velocity, radius and separation: {reason}") from error


def _grid_jobs(study: Study, source: str) -> list[Job]:
    axes = _axes(study.axes or {}, source)
    jobs = []
    for values in product(*axes.values()):
        collision = study.collision_with(dict(zip(axes, values, strict=True)), source)
        index = {key: value_at(collision, key) for key in axes}
        jobs.append(_job(collision, alias(index), index, source))
    return jobs


def _case_jobs(study: Study, source: str) -> list[Job]:
    if not study.cases:
        raise SceneError(f"{source}: 'cases' is empty; give at least one [[cases]] table")
    jobs = []
    for number, case in enumerate(study.cases, start=1):
        changes = flatten(case)
        collision = study.collision_with(changes, f"{source}: case {number}")
        label = alias({key: value_at(collision, key) for key in ordered(changes)})
        jobs.append(_job(collision, label, {"case": label}, f"{source}: case {number}"))
    return jobs


def _job(collision: Collision, label: str, index: dict[str, Any], source: str) -> Job:
    name = job_id(label, scene_of(collision, source).hash())
    return Job(id=name, directory=f"jobs/{name}", index=index, collision=collision)


def _axes(table: dict[str, Any], source: str) -> dict[str, list[Any]]:
    """The axes in order, each a list of different single values of the collision."""
    axes = flatten(table)
    if not axes:
        raise SceneError(f"{source}: 'axes' is empty; give at least one, as velocity = [100, 200]")
    for key, values in axes.items():
        _require_scalar_key(key, source)
        _require_values(key, values, source)
    return {key: axes[key] for key in ordered(axes)}


def _require_scalar_key(key: str, source: str) -> None:
    known = list(scalar_keys(Collision))
    inside = [name for name in known if name.startswith(f"{key}.")]
    if inside:
        raise SceneError(f"{source}: 'axes.{key}' is a table; name one of its values: {', '.join(inside)}")
    if key not in known:
        raise SceneError(f"{source}: unknown key 'axes.{key}'{suggestion(key, known)}")


def _require_values(key: str, values: Any, source: str) -> None:
    if not isinstance(values, list) or not values:
        raise SceneError(f"{source}: 'axes.{key}' must be a list of at least one value (given {values!r})")
    for number, value in enumerate(values):
        if isinstance(value, list | dict):
            raise SceneError(f"{source}: 'axes.{key}' must hold single values (given {value!r})")
        if value in values[:number]:
            raise SceneError(f"{source}: 'axes.{key}' holds {value!r} twice; give every value once")


def _refuse_equal_jobs(jobs: list[Job], source: str) -> None:
    for first, second in _equal_pairs(jobs):
        given = " and ".join(", ".join(f"{key} {value}" for key, value in job.index.items()) for job in (first, second))
        raise SceneError(f"{source}: {given} are the same simulation; keep one of them")


def _equal_pairs(jobs: list[Job]) -> Iterator[tuple[Job, Job]]:
    """Jobs of the same scene, or of the same place in the results."""
    seen: dict[Any, Job] = {}
    for job in jobs:
        for mark in (job.id.rpartition("-")[2], tuple(job.index.items())):
            if mark in seen:
                yield seen[mark], job
            seen[mark] = job
