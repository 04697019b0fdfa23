"""Error against CPU time: every verification scene at every value of every knob."""

from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd
import xarray as xr

from engine import PHYSICS_VERSION
from engine.device import backend
from engine.device.options import Precision
from engine.job.storage import write_dataset
from engine.verification.accuracy.settings import TRADEOFFS
from engine.verification.harness import fitted_order, settings
from engine.verification.processes import in_own_process

KEYS = ["scene", "knob", "value"]

ATTRIBUTES = {
    "error": {"long_name": "error against the exact solution or published values", "units": "1"},
    "cpu_time": {"long_name": "CPU time of all time steps", "units": "s"},
}


@dataclass(frozen=True)
class Run:
    """One scene with one knob turned.

    Attributes:
        scene: name of the verification scene.
        knob: what is turned: `particles`, `cells` or `steps`, or a dotted key of the scene.
        value: where it is turned to, as text.
        error: see `Tradeoff.quantity`.
        cpu_time: of all time steps [s], kernels compiled before.
    """

    scene: str
    knob: str
    value: str
    error: float
    cpu_time: float


def measure(scene: str, knob: str, value: Any) -> Run:
    """Run one scene in this process, which must have started nothing else."""
    backend.start(threads=1)
    tradeoff = TRADEOFFS[scene]
    turned = knob == tradeoff.resolution
    with settings({} if turned else {knob: value}) as times:
        error = tradeoff.error(value if turned else tradeoff.values[0])
    return Run(scene, knob, str(value), error, sum(times))


def sweep(scenes: Iterable[str], path: Path, workers: int) -> Iterator[Run]:
    """All runs that the file at `path` does not hold yet, each in a process of its own; the file grows with each."""
    done = read(path)
    known = set() if done.empty else set(done[KEYS].itertuples(index=False, name=None))
    wanted = [(scene, knob, value) for scene in scenes for knob, value in TRADEOFFS[scene].runs]
    missing = [run for run in wanted if (*run[:2], str(run[2])) not in known]
    for run in _measure_all(missing, workers):
        done = pd.concat([done, pd.DataFrame([asdict(run)])], ignore_index=True)
        write(path, done)
        yield run


def _measure_all(runs: list[tuple[str, str, Any]], workers: int) -> Iterator[Run]:
    """Runs as they end, so many at the same time."""
    with ThreadPoolExecutor(workers) as threads:
        for job in as_completed([threads.submit(in_own_process, _precision(run), measure, *run) for run in runs]):
            yield job.result()


def _precision(run: tuple[str, str, Any]) -> Precision:
    """What a run computes in, which is the knob of some."""
    _, knob, value = run
    return cast(Precision, value) if knob == "numerics.precision" else "f64"


def read(path: Path) -> pd.DataFrame:
    """The runs in a file, none if there is no such file or it was made by other physics."""
    empty = pd.DataFrame(columns=[*KEYS, "error", "cpu_time"])
    if not path.is_file():
        return empty
    with xr.open_dataset(path) as dataset:
        current = dataset.attrs["physics_version"] == PHYSICS_VERSION
        return dataset.load().to_dataframe().reset_index(drop=True) if current else empty


def write(path: Path, runs: pd.DataFrame) -> None:
    """Runs as a data set with the dimension `run`."""
    dataset = xr.Dataset.from_dataframe(runs.rename_axis("run"))
    for name, attributes in ATTRIBUTES.items():
        dataset[name].attrs = attributes
    dataset.attrs = {"Conventions": "CF-1.11", "physics_version": PHYSICS_VERSION}
    write_dataset(path, dataset)


def orders(runs: pd.DataFrame) -> pd.DataFrame:
    """Exponent q of error ~ value^q for resolutions and time steps, by scene and knob."""
    rows = []
    for (scene, knob), group in runs.groupby(["scene", "knob"], sort=False):
        if knob in ("particles", "cells", "steps", "numerics.cfl") and len(group) > 1:
            sizes = np.asarray(group["value"], dtype=float) ** (-1.0 / 3.0 if knob == "particles" else 1.0)
            sign = -1.0 if knob in ("cells", "steps") else 1.0
            rows.append((scene, knob, sign * fitted_order(list(sizes), list(group["error"]))))
    return pd.DataFrame(rows, columns=["scene", "knob", "order in dx or dt"])
