"""Conservation in a run: the relative change of each conserved quantity over its history."""

from pathlib import Path

import numpy as np
import xarray as xr

from engine.errors import JobError
from engine.job.storage import read_dataset
from engine.quantities import CONSERVED, HEATS, HISTORY
from engine.scene.bodies import Body
from engine.scene.scene import Scene

NEGLIGIBLE = 1e-6
"""An initial angular momentum below this fraction of sum m |x| |v| counts as zero: a head-on impact."""


def read_history(path: Path) -> xr.Dataset:
    """The history of a run.

    Raises:
        JobError: the file is missing, damaged, empty, or lacks a quantity.
    """
    history = read_dataset(path)
    missing = [name for name in ("time", "kinetic_energy", *HEATS, *CONSERVED) if name not in history.variables]
    if missing or not history.sizes["time"]:
        raise JobError(f"{path}: not a history: lacks {', '.join(missing) or 'any row'}")
    return history


def drifts(history: xr.Dataset, scene: Scene) -> xr.Dataset:
    """Relative change since the start of every conserved quantity [-], over `time` [s].

    Mass is relative to its start; momentum to sum m |v| and angular momentum to |L| of the bodies at the start
    (NaN without any); energy to the kinetic energy at the start. Vectors give the magnitude of their change.
    """
    start = history.isel(time=0)
    momentum, angular_momentum = _scales(scene)
    scales = {
        "mass": float(start["mass"]),
        "momentum": momentum,
        "angular_momentum": angular_momentum,
        "total_energy": float(start["kinetic_energy"]),
    }
    return xr.Dataset({name: _size(history[name] - start[name]) / _scale(scales[name]) for name in CONSERVED})


def heats(history: xr.Dataset) -> dict[str, float]:
    """Energy that motion has lost at the end, by cause, relative to the kinetic energy at the start [-]."""
    start = _scale(float(history["kinetic_energy"][0]))
    return {name: float(history[name][-1]) / start for name in HEATS}


def _scales(scene: Scene) -> tuple[float, float]:
    """sum m |v| [kg m/s] and |sum L| [kg m^2/s] of the bodies; the latter 0 when negligible."""
    momentum = sum(body.mass * float(np.linalg.norm(body.velocity)) for body in scene.bodies)
    total = float(np.linalg.norm(sum((_angular_momentum(body) for body in scene.bodies), np.zeros(3))))
    largest = sum(
        body.mass * float(np.linalg.norm(body.position) * np.linalg.norm(body.velocity)) for body in scene.bodies
    )
    return momentum, total if total > NEGLIGIBLE * largest else 0.0


def _angular_momentum(body: Body) -> np.ndarray:
    return np.asarray(body.mass * np.cross(body.position, body.velocity) + body.spin_momentum)


def _size(change: xr.DataArray) -> xr.DataArray:
    """Magnitude of a vector; a scalar keeps its sign."""
    is_vector = HISTORY[str(change.name)].is_vector
    return (change**2).sum("space", skipna=False) ** 0.5 if is_vector else change


def _scale(value: float) -> float:
    return value if value > 0.0 else float("nan")
