"""Running a scene in memory, and reading it as its equations name things."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.particles import Arrays
from engine.scene import Scene
from engine.simulation import Simulation

Array = NDArray[np.float64]


def begin(scene: Scene, **changes: NDArray[Any]) -> Simulation:
    """A scene at its start, whole fields of its state replaced by `changes`."""
    simulation = Simulation(scene)
    simulation.start(**changes)
    return simulation


def follow(simulation: Simulation, until: float) -> "Moment":
    """The state at the first step that reaches `until` [s].

    Raises:
        RunFault: a particle left the range in which the equations hold.
    """
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
        return np.asarray(self.state["root"] ** 3)


def fitted_order(sizes: list[float], errors: list[float]) -> float:
    """Exponent q of the power law error ~ size^q that fits best."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])
