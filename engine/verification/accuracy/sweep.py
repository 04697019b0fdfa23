"""Error against CPU time: every verification scene at every value of every setting."""

from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import cast

import numpy as np
import pandas as pd
import xarray as xr

from engine import PHYSICS_VERSION
from engine.device import backend
from engine.device.options import Precision
from engine.job.storage import write_dataset
from engine.verification.accuracy.settings import TRADEOFFS
from engine.verification.harness import Harness, Setting, fitted_order
from engine.verification.processes import in_own_process

KEYS = ["scene", "setting", "value"]

ROUND_OFF = 1e-12
"""Relative error below which it is round-off."""

ATTRIBUTES = {
    "error": {"long_name": "error against the exact solution or published values", "units": "1"},
    "cpu_time": {"long_name": "CPU time of all time steps", "units": "s"},
}


@dataclass(frozen=True)
class Trial:
    """One scene with one setting varied.

    Attributes:
        scene: name of the verification scene.
        setting: what is varied: `particles`, `cells` or `steps`, or a dotted key of the scene.
        value: its value, as text.
        error: that of `Tradeoff.quantity`.
        cpu_time: of all time steps [s], without compilation.
    """

    scene: str
    setting: str
    value: str
    error: float
    cpu_time: float


def measure(scene: str, setting: str, value: Setting) -> Trial:
    """Run one scene with one setting varied; this process must not have started Taichi before."""
    backend.start(threads=1)
    tradeoff = TRADEOFFS[scene]
    if setting == tradeoff.resolution:
        harness, resolution = Harness(), int(value)
    else:
        harness, resolution = Harness({setting: value}), tradeoff.resolutions[0]
    error = tradeoff.error(harness, resolution)
    return Trial(scene, setting, str(value), error, harness.cpu_time)


def sweep(scenes: Iterable[str], path: Path, workers: int) -> Iterator[Trial]:
    """Do all runs that a file lacks, each in a process of its own; yield each as it ends.

    Args:
        scenes: names of verification scenes.
        path: the file, written anew after each run.
        workers: runs at the same time.
    """
    done = read(path)
    known = set() if done.empty else set(done[KEYS].itertuples(index=False, name=None))
    wanted = [(scene, *run) for scene in scenes for run in TRADEOFFS[scene].runs]
    missing = [run for run in wanted if (*run[:2], str(run[2])) not in known]
    for run in _measure_all(missing, workers):
        done = pd.concat([done, pd.DataFrame([asdict(run)])], ignore_index=True)
        write(path, done)
        yield run


def _measure_all(runs: list[tuple[str, str, Setting]], workers: int) -> Iterator[Trial]:
    """The runs as they end."""
    with ThreadPoolExecutor(workers) as threads:
        for job in as_completed([threads.submit(_measure_apart, run) for run in runs]):
            yield job.result()


def _measure_apart(run: tuple[str, str, Setting]) -> Trial:
    return in_own_process(_precision(run), measure, *run)


def _precision(run: tuple[str, str, Setting]) -> Precision:
    """The precision of a run, which is the setting that some vary."""
    _, setting, value = run
    return cast(Precision, value) if setting == "numerics.precision" else "f64"


def read(path: Path) -> pd.DataFrame:
    """Return the runs in a file; none if there is no such file or another version of the physics made it."""
    empty = pd.DataFrame(columns=[*KEYS, "error", "cpu_time"])
    if not path.is_file():
        return empty
    with xr.open_dataset(path) as dataset:
        current = dataset.attrs["physics_version"] == PHYSICS_VERSION
        return dataset.load().to_dataframe().reset_index(drop=True) if current else empty


def write(path: Path, runs: pd.DataFrame) -> None:
    """Write runs as a netCDF data set with the dimension `run`."""
    dataset = xr.Dataset.from_dataframe(runs.rename_axis("run"))
    for name, attributes in ATTRIBUTES.items():
        dataset[name].attrs = attributes
    dataset.attrs = {"Conventions": "CF-1.11", "physics_version": PHYSICS_VERSION}
    write_dataset(path, dataset)


def orders(runs: pd.DataFrame) -> pd.DataFrame:
    """Return the exponent q of error ~ dx^q or dt^q for resolutions and time steps, by scene and setting.

    Errors of round-off have no order.
    """
    rows = []
    for (scene, setting), group in runs.groupby(["scene", "setting"], sort=False):
        varied = setting in ("particles", "cells", "steps", "numerics.cfl") and len(group) > 1
        if varied and group["error"].min() > ROUND_OFF:
            sizes = np.asarray(group["value"], dtype=float) ** (-1.0 / 3.0 if setting == "particles" else 1.0)
            sign = -1.0 if setting in ("cells", "steps") else 1.0
            rows.append((scene, setting, sign * fitted_order(list(sizes), list(group["error"]))))
    return pd.DataFrame(rows, columns=["scene", "setting", "order in dx or dt"])
