"""A collision to late time: the state that codes are compared on, and what gravity cost and erred on the way there."""

import json
from functools import wraps
from pathlib import Path
from typing import Any

import xarray as xr

from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from engine.gravity.self_gravity import SelfGravity
from engine.job.session import Options, run_job
from engine.scene.collision import Collision
from engine.scene.scene import Gravity
from tests.benchmarks.child import answer
from tests.benchmarks.gravity.curve import error
from tests.benchmarks.gravity.states import PER_BODY, State, save
from tests.benchmarks.stopwatch import Stopwatch
from tests.helpers.gravity import accelerations

AFTER_CONTACT = 10_000.0


def measure(directory: str, state: str) -> dict[str, Any]:
    """Run a (200 m/s, 15 deg) collision, save its last state, and return what gravity cost.

    A run that was stopped is resumed, and the cost is then that of its last session.
    """
    path = Path(directory)
    cost = path / "cost.json"
    if not cost.exists():
        found = run(path, Path(state))
        cost.write_text(json.dumps(found), encoding="utf-8")
    return dict(json.loads(cost.read_text(encoding="utf-8")))


def run(directory: Path, state_path: Path) -> dict[str, Any]:
    """The collision as a job, with gravity under a watch."""
    directory.mkdir(parents=True, exist_ok=True)
    scene = Collision(velocity=200.0, angle=15.0, particles=PER_BODY, end_time=AFTER_CONTACT).scene()
    (directory / "scene.json").write_text(scene.canonical(), encoding="utf-8")
    watches = {name: watched(SelfGravity, name) for name in ("accelerate", "energy")}
    whole = Stopwatch()
    with whole.lap():
        status = run_job(directory, Options(threads=1))
    with xr.open_dataset(directory / "final.nc") as final:
        state = State(final["position"].values, final["mass"].values, scene.spacing)
    save(state, state_path)
    spent = {name: {"calls": len(watch.cpu), "cpu_s": sum(watch.cpu)} for name, watch in watches.items()}
    return {"time": status.time, "steps": status.step, "cpu_s": whole.cpu[0], **spent, **error_of_defaults(state)}


def watched(kind: type, name: str) -> Stopwatch:
    """A watch that from now on times all calls of a method."""
    watch, method = Stopwatch(), getattr(kind, name)

    @wraps(method)
    def timed(*arguments: Any, **named: Any) -> Any:
        with watch.lap():
            return method(*arguments, **named)

    setattr(kind, name, timed)
    return watch


def error_of_defaults(state: State) -> dict[str, float]:
    """Relative errors of the accelerations that a simulation uses, with the default opening."""
    particles = state.particles()
    BarnesHut(particles, state.radius, Gravity().opening).accelerate(0.0)
    used = particles.read("acceleration")["acceleration"]
    return error(used, accelerations(DirectSum(particles, state.radius)))


if __name__ == "__main__":
    answer(measure)
