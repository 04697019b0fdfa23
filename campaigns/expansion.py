"""From a study to its jobs."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from pydantic import ValidationError

from campaigns.campaign import Campaign, Job
from campaigns.dotted_keys import flatten, ordered, rest_of, scalar_keys, value_at, with_names_of
from campaigns.job_names import alias, hash_in, job_id
from campaigns.study import Study
from engine import PHYSICS_VERSION
from engine.errors import SceneError
from engine.scene.collision import Collision
from engine.scene.input_errors import did_you_mean
from engine.scene.keys import current_key
from engine.scene.scene import Scene


def expand(study: Study, source: str) -> Campaign:
    """All jobs of a study, each with its scene built once to see that it can be.

    Args:
        study: axes, cases or both over shared settings.
        source: the file that errors name.

    Raises:
        SceneError: a key or value is wrong, or two jobs would be the same.
    """
    if study.axes is None and study.cases is None:
        raise SceneError(f"{source}: give [axes], for all combinations of values, or [[cases]], one by one, or both")
    study.shared_settings(f"{source}: collision")
    _refuse_second_seeds(study, source)
    jobs = list(_jobs(study, source))
    _refuse_equal_jobs(jobs, source)
    dims = tuple(jobs[0].index)
    coords = {dim: tuple(dict.fromkeys(job.index[dim] for job in jobs)) for dim in dims}
    return Campaign(
        name=study.name, physics_version=PHYSICS_VERSION, study=study, dims=dims, coords=coords, jobs=tuple(jobs)
    )


def scene_of(collision: Collision, source: str) -> Scene:
    """The scene of a collision.

    Raises:
        SceneError: no orbit leads to this collision, its numbers leave the range of floating point, or a material
            lacks a constant.
    """
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            return collision.scene()
    except SceneError as error:
        raise SceneError(f"{source}: {error}") from error
    except (ValueError, ArithmeticError, IndexError) as error:
        text = error.errors()[0]["msg"] if isinstance(error, ValidationError) else str(error)
        keys = ("velocity", "target.radius", "start_separation")
        given = ", ".join(f"{key} {value_at(collision, key):g}" for key in keys)
        reason = " ".join(text.removeprefix("Value error, ").split())
        raise SceneError(f"{source}: no scene can be built from {given}: {reason}") from error


@dataclass(frozen=True)
class _Case:
    """What the jobs of one case share; a study without cases is one case without coordinates and changes."""

    coordinates: dict[str, str]
    changes: dict[str, Any]
    source: str


def _jobs(study: Study, source: str) -> Iterator[Job]:
    axes = {} if study.axes is None else _axes(study.axes, source)
    for case in _cases(study, axes, source):
        for values in product(*_kept(axes, case).values()):
            collision = study.collision_with(case.changes | dict(zip(axes, values, strict=True)), case.source)
            point = {key: value_at(collision, key) for key in axes}
            for which, member in _members(study, collision):
                yield _job(member, case.coordinates, {**point, **which}, case.source)


def _members(study: Study, collision: Collision) -> Iterable[tuple[dict[str, Any], Collision]]:
    """The collisions of one point of the study with their coordinates there."""
    return study.error_bars.members(collision) if study.error_bars else [({}, collision)]


def _cases(study: Study, axes: dict[str, Any], source: str) -> Iterator[_Case]:
    if study.cases is None:
        yield _Case({}, {}, source)
        return
    if not study.cases:
        raise SceneError(f"{source}: 'cases' is empty; give at least one [[cases]] table")
    for number, case in enumerate(study.cases, start=1):
        origin = f"{source}: case {number}"
        first = {key: values[0] for key, values in axes.items()}
        collision = study.collision_with(first | case.settings, origin)
        name = case.name or alias({key: value_at(collision, key) for key in ordered(case.settings) if key not in axes})
        yield _Case({"case": name}, case.settings, origin)


def _kept(axes: dict[str, list[Any]], case: _Case) -> dict[str, list[Any]]:
    """The values of each axis that a case is run at: all of them, or the one it sets itself."""
    for key, given in product(axes, case.changes):
        if key.startswith(f"{given}.") or given.startswith(f"{key}."):
            raise SceneError(f"{case.source}: '{given}' and 'axes.{key}' are parts of each other; keep one of them")
    for key in axes.keys() & case.changes.keys():
        if case.changes[key] not in axes[key]:
            raise SceneError(
                f"{case.source}: '{key}' is {case.changes[key]!r}, which 'axes.{key}' does not contain; "
                "add it there, or leave it out to run the case at all values of the axis"
            )
    return {key: [case.changes[key]] if key in case.changes else values for key, values in axes.items()}


def _job(collision: Collision, case: dict[str, str], point: dict[str, Any], source: str) -> Job:
    parts = [*case.values(), *([alias(point)] if point else [])]
    name = job_id("_".join(parts), scene_of(collision, source).hash())
    return Job(id=name, directory=f"jobs/{name}", index={**case, **point}, collision=collision)


def _axes(table: dict[str, Any], source: str) -> dict[str, list[Any]]:
    """The axes in order, each a list of different single values of the collision."""
    axes = flatten(table)
    if not axes:
        raise SceneError(f"{source}: 'axes' is empty; give at least one, as velocity = [100, 200]")
    for key, values in axes.items():
        _require_scalar_key(key, source)
        _require_values(key, values, source)
    return {key: axes[key] for key in ordered(axes)}


def _refuse_second_seeds(study: Study, source: str) -> None:
    """With error bars, seeds are theirs to choose."""
    given = {"collision": study.collision, "axes": flatten(study.axes or {})}
    given |= {f"case {number}": case.settings for number, case in enumerate(study.cases or [], start=1)}
    for table, settings in given.items():
        if study.error_bars and "seed" in settings:
            raise SceneError(f"{source}: {table}: 'seed' is chosen by error_bars.seeds; leave it out here")


def _require_scalar_key(key: str, source: str) -> None:
    known = [with_names_of(key, name) for name in scalar_keys(Collision)]
    rests = [rest for rest in (rest_of(key, name) for name in known) if rest is not None]
    if renamed := current_key(Collision, key):
        raise SceneError(f"{source}: 'axes.{key}' is now 'axes.{renamed}'")
    if not rests:
        raise SceneError(f"{source}: unknown key 'axes.{key}'{did_you_mean(key, known)}")
    if any(rests):
        inside = ", ".join(f"{key}.{rest}" for rest in rests)
        raise SceneError(f"{source}: 'axes.{key}' is a table; name one of its values: {inside}")


def _require_values(key: str, values: Any, source: str) -> None:
    if not isinstance(values, list) or not values:
        raise SceneError(f"{source}: 'axes.{key}' must be a list of at least one value (given {values!r})")
    for number, value in enumerate(values):
        if isinstance(value, list | dict):
            raise SceneError(f"{source}: 'axes.{key}' must be a list of single values (given {value!r})")
        if value in values[:number]:
            raise SceneError(f"{source}: 'axes.{key}' contains {value!r} twice; give every value once")
    if any(value is False for value in values) and any(type(value) in (int, float) for value in values):
        raise SceneError(
            f"{source}: 'axes.{key}' mixes false with numbers, among which it has no coordinate: "
            "set it in [[cases]], or give a number that means the same (for no spin a period of 1e9 h)"
        )


def _refuse_equal_jobs(jobs: list[Job], source: str) -> None:
    for first, second in _equal_pairs(jobs):
        given = " and ".join(", ".join(f"{key} {value}" for key, value in job.index.items()) for job in (first, second))
        same = hash_in(first.id) == hash_in(second.id)
        fault = "are the same simulation; keep one of them" if same else "coincide; give cases different names"
        raise SceneError(f"{source}: {given} {fault}")


def _equal_pairs(jobs: list[Job]) -> Iterator[tuple[Job, Job]]:
    """Jobs of the same scene, or of the same coordinates in the results."""
    seen: dict[Any, Job] = {}
    for job in jobs:
        for mark in (hash_in(job.id), tuple(job.index.items())):
            if mark in seen:
                yield seen[mark], job
            seen[mark] = job
