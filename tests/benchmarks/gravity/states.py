"""The particles that all codes are measured on."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.state.particles import Particles

SPHERE, LATE = "uniform sphere", "late collision"
PER_BODY = 20_000


@dataclass(frozen=True)
class State:
    """Positions [m] and masses [kg] of particles, and the radius [m] within which a particle's pull is softened."""

    x: NDArray[np.float64]
    mass: NDArray[np.float64]
    radius: float

    def particles(self) -> Particles:
        """The same on the device, at rest; Taichi must have been started."""
        result = Particles(len(self.x))
        result.write({"x": self.x, "v": np.zeros_like(self.x), "mass": self.mass})
        return result


def sphere(count: int) -> State:
    """Particles at random in a sphere of basalt with a radius of 50 km."""
    generator = np.random.default_rng(3)
    x = generator.normal(size=(count, 3))
    x *= (50e3 * generator.uniform(size=count) ** (1.0 / 3.0) / np.linalg.norm(x, axis=1))[:, None]
    volume = 4.0 / 3.0 * np.pi * 50e3**3 / count
    return State(x, np.full(count, 2700.0 * volume), float(volume ** (1.0 / 3.0)))


def along_curve(state: State) -> State:
    """The same particles in the order of a Morton curve, so that no code loses time by the order it is given."""
    low = state.x.min(axis=0)
    cells = ((state.x - low) * (2**20 / (np.ptp(state.x, axis=0).max() * (1.0 + 1e-9)))).astype(np.int64)
    keys = sum((((cells >> bit) & 1) @ [1, 2, 4]) << (3 * bit) for bit in range(20))
    order = np.argsort(keys)
    return State(state.x[order], state.mass[order], state.radius)


def save(state: State, path: Path) -> None:
    """Write a state where other processes find it."""
    np.savez(path, x=state.x, mass=state.mass, radius=state.radius)


def load(path: Path) -> State:
    """A state that was saved."""
    with np.load(path) as stored:
        return State(stored["x"], stored["mass"], float(stored["radius"]))
