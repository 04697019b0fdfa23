"""The particles that all codes are measured on."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from engine.collision import Collision
from engine.run import Options, run_job

SPHERE, LATE = "uniform sphere", "late collision"
PER_BODY, AFTER_CONTACT = 20_000, 4000.0


@dataclass(frozen=True)
class State:
    """Positions [m] and masses [kg] of particles, and the radius [m] within which a particle's pull is softened."""

    x: NDArray[np.float64]
    mass: NDArray[np.float64]
    radius: float


def sphere(count: int) -> State:
    """Particles anywhere in a sphere of basalt with a radius of 50 km."""
    generator = np.random.default_rng(3)
    x = generator.normal(size=(count, 3))
    x *= (50e3 * generator.uniform(size=count) ** (1.0 / 3.0) / np.linalg.norm(x, axis=1))[:, None]
    volume = 4.0 / 3.0 * np.pi * 50e3**3 / count
    return State(x, np.full(count, 2700.0 * volume), float(volume ** (1.0 / 3.0)))


def late(directory: Path) -> State:
    """A (200 m/s, 15 deg) collision long after contact; it is computed unless `directory` holds it already."""
    directory.mkdir(parents=True, exist_ok=True)
    scene = Collision(velocity=200.0, angle=15.0, particles=PER_BODY, end_time=AFTER_CONTACT).scene()
    (directory / "scene.json").write_text(scene.canonical(), encoding="utf-8")
    run_job(directory, Options(threads=1))
    with xr.open_dataset(directory / "final.nc") as final:
        return State(final["position"].values, final["mass"].values, scene.spacing)


def save(state: State, path: Path) -> None:
    """Write a state where other processes find it."""
    np.savez(path, x=state.x, mass=state.mass, radius=state.radius)


def load(path: Path) -> State:
    """A state that was saved."""
    with np.load(path) as stored:
        return State(stored["x"], stored["mass"], float(stored["radius"]))
