"""Running a scene in memory, and its state in the terms of its equations."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from engine.scene.fields import Model
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import Arrays

Array = NDArray[np.float64]

Setting = int | float | str
"""A value that a setting can have."""


@dataclass
class Harness:
    """Runs scenes at settings of one's choice and adds up what their steps cost.

    Attributes:
        settings: values that replace those of every scene, by dotted key (`numerics.cfl`); a setting of a part of the
            physics that a scene leaves out has no effect on it.
        cpu_time: CPU time of all steps so far [s], without compilation.
    """

    settings: Mapping[str, Setting] = field(default_factory=dict)
    cpu_time: float = 0.0

    def start(self, scene: Scene, **fields: NDArray[np.generic]) -> Simulation:
        """Return a simulation of the scene at its start, its kernels compiled.

        Args:
            scene: what to run; the harness's settings replace its own.
            fields: whole fields of the initial state that replace the scene's own, shape [particle_count, ...].
        """
        for key, value in self.settings.items():
            scene = altered(scene, key, value)
        simulation = Simulation(scene)
        simulation.start(**fields)
        simulation.advance(scene.start_time)
        return simulation

    def run_until(self, simulation: Simulation, end: float) -> "State":
        """Advance a simulation; return its state after the first step that reaches the time `end` [s], or its own end.

        Raises:
            RunFault: a particle left the range in which the equations hold.
        """
        with self.timed():
            while simulation.time < min(end, simulation.scene.end_time):
                simulation.advance(end)
        return State(simulation.time, simulation.particles.read())

    @contextmanager
    def timed(self) -> Iterator[None]:
        """Add the CPU time of the enclosed steps to `cpu_time`."""
        begun = time.process_time()
        yield
        self.cpu_time += time.process_time() - begun


def altered(model: Model, key: str, value: object) -> Model:
    """Return a model with the value at a dotted key replaced, unchecked; a part that is left out stays so."""
    name, _, rest = key.partition(".")
    part = getattr(model, name)
    if rest and part is None:
        return model
    return model.model_copy(update={name: altered(part, rest, value) if rest else value})


@dataclass(frozen=True)
class State:
    """All particles at one time.

    Attributes:
        time: simulated time [s].
        fields: quantities of the particles by name (engine/state/particles.py), shape [particle_count, ...].
    """

    time: float
    fields: Arrays

    @property
    def x(self) -> Array:
        """Positions [m], shape [particle_count, 3]."""
        return np.asarray(self.fields["x"])

    @property
    def v(self) -> Array:
        """Velocities [m/s], shape [particle_count, 3]."""
        return np.asarray(self.fields["v"])

    @property
    def speed(self) -> Array:
        """Speeds |v| [m/s], shape [particle_count]."""
        return np.asarray(np.linalg.norm(self.v, axis=1))

    @property
    def J(self) -> Array:
        """det F = rho0/rho [-], shape [particle_count]."""
        return np.asarray(1.0 + self.fields["j"])

    @property
    def P(self) -> Array:
        """Mean stress -tr(tau)/(3 J) [Pa], positive in compression, shape [particle_count]."""
        return np.asarray(-self.fields["tau"][:, :3].mean(axis=1) / self.J)

    @property
    def damage(self) -> Array:
        """Damage [-], shape [particle_count]."""
        return np.asarray(self.fields["damage_root"] ** 3)


def fitted_order(sizes: list[float], errors: list[float]) -> float:
    """Return the exponent q of the power law error ~ size^q that fits best, by least squares of logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])
