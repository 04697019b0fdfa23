"""Running a scene in memory, and reading it as its equations name things."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.scene.fields import Model
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import Arrays

Array = NDArray[np.float64]


_settings: ContextVar[dict[str, Any]] = ContextVar("settings")
_stepping: ContextVar[list[float]] = ContextVar("stepping")


@contextmanager
def settings(values: dict[str, Any]) -> Iterator[list[float]]:
    """Scenes that begin inside take on these values by dotted key; yields a list of CPU times [s] spent on steps."""
    times: list[float] = []
    tokens = _settings.set(values), _stepping.set(times)
    try:
        yield times
    finally:
        _settings.reset(tokens[0])
        _stepping.reset(tokens[1])


@contextmanager
def timed() -> Iterator[None]:
    """Counts the CPU time of what runs inside as spent on steps."""
    begun = time.process_time()
    yield
    _stepping.get([]).append(time.process_time() - begun)


def altered(model: Model, key: str, value: Any) -> Model:
    """A model with the value at a dotted key replaced; a part that is left out stays so."""
    name, _, rest = key.partition(".")
    part = getattr(model, name)
    if rest and part is None:
        return model
    return model.model_copy(update={name: altered(part, rest, value) if rest else value})


def begin(scene: Scene, **changes: NDArray[Any]) -> Simulation:
    """A scene at its start, its kernels compiled, and whole fields of its state replaced by `changes`."""
    for key, value in _settings.get({}).items():
        scene = altered(scene, key, value)
    simulation = Simulation(scene)
    simulation.start(**changes)
    simulation.advance(scene.start_time)
    return simulation


def follow(simulation: Simulation, until: float) -> "Moment":
    """The state at the first step that reaches `until` [s].

    Raises:
        RunFault: a particle left the range in which the equations hold.
    """
    with timed():
        while simulation.time < min(until, simulation.scene.end_time):
            simulation.advance(until)
    return Moment(simulation.time, simulation.particles.read())


@dataclass(frozen=True)
class Moment:
    """All particles at one time [s]."""

    time: float
    state: Arrays

    @property
    def x(self) -> Array:
        """Positions [m], shape [particle_count, 3]."""
        return np.asarray(self.state["x"])

    @property
    def v(self) -> Array:
        """Velocities [m/s], shape [particle_count, 3]."""
        return np.asarray(self.state["v"])

    @property
    def speed(self) -> Array:
        """Speeds [m/s], shape [particle_count]."""
        return np.asarray(np.linalg.norm(self.v, axis=1))

    @property
    def J(self) -> Array:
        """det F [-], shape [particle_count]."""
        return np.asarray(1.0 + self.state["j"])

    @property
    def P(self) -> Array:
        """Mean stress [Pa], positive in compression, shape [particle_count]."""
        return np.asarray(-self.state["tau"][:, :3].mean(axis=1) / self.J)

    @property
    def damage(self) -> Array:
        """Damage [-], shape [particle_count]."""
        return np.asarray(self.state["damage_root"] ** 3)


def fitted_order(sizes: list[float], errors: list[float]) -> float:
    """Exponent q of the power law error ~ size^q that fits best."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])
