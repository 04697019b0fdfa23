"""Two bodies in orbit about each other, through all of the engine's time integration, gravity held for an interval."""

from dataclasses import dataclass

import numpy as np
import pytest

from engine.constants import G_NEWTON
from engine.device import backend
from engine.scene.bodies import Sphere
from engine.scene.scene import Gravity, Numerics, Physics, Scene
from engine.simulation.simulation import Simulation
from engine.verification.problems.materials import elastic
from tests.helpers.device import Array

AXIS, ECCENTRICITY, TURNS = 1e6, 0.2, 20
SOFT = elastic(2700.0, 1e-9, 1e-9)
"""No wave in it limits the time step."""
STAR = Sphere(radius=50e3, particles=1, hydrostatic=False, material=SOFT)
MU = 2.0 * G_NEWTON * STAR.mass
PERIOD = 2.0 * np.pi * np.sqrt(AXIS**3 / MU)
STEPS = 4
"""Time steps per interval, a trifle longer than its parts, so that evaluations come regularly."""


@dataclass(frozen=True)
class Orbit:
    """Relative motion at the ends of all intervals: time in periods, energy and angular momentum per mass, angle."""

    time: Array
    energy: Array
    momentum: Array
    angle: Array

    def drift(self) -> float:
        """Relative difference of the energy between the first and the last turn."""
        return float(self.energy[self.time < 1.0].mean() / self.energy[self.time > TURNS - 1.0].mean() - 1.0)


def scene(interval: float) -> Scene:
    """A pair of one particle each; a mote that leaves at constant speed keeps the time step constant."""
    distance, speed = AXIS * (1.0 - ECCENTRICITY), np.sqrt(MU / AXIS * (1.0 + ECCENTRICITY) / (1.0 - ECCENTRICITY))
    pair = [
        STAR.model_copy(
            update={"position": (0.5 * sign * distance, 0.0, 0.0), "velocity": (0.0, 0.5 * sign * speed, 0.0)}
        )
        for sign in (-1.0, 1.0)
    ]
    numerics = Numerics()
    pace = numerics.cfl * STAR.spacing * numerics.particles_per_cell ** (1.0 / 3.0) / (interval / (STEPS - 1e-4))
    away = {"position": (0.0, 0.0, 1e9), "velocity": (0.0, 0.0, pace)}
    mote = STAR.model_copy(update={"radius": 100.0, **away})
    physics = Physics(shear=False, strength=False, fracture=None, gravity=Gravity(interval=interval))
    return Scene(bodies=(*pair, mote), end_time=TURNS * PERIOD, physics=physics, numerics=numerics)


def follow(intervals: int) -> Orbit:
    """The orbit with so many intervals per turn."""
    backend.start(threads=1)
    simulation = Simulation(scene(PERIOD / intervals))
    simulation.start()
    rows = []
    while not simulation.finished:
        simulation.advance(TURNS * PERIOD)
        state = simulation.particles.read("x", "v")
        x, v = (values[1] - values[0] for values in (state["x"], state["v"]))
        # from the middle of the step to its end
        v = v - 0.5 * float(simulation.clock.dt[None]) * MU * x / np.sqrt(x @ x) ** 3
        energy = 0.5 * v @ v - MU / np.sqrt(x @ x)
        rows.append((simulation.time / PERIOD, energy, np.cross(x, v)[2], np.arctan2(x[1], x[0])))
    return Orbit(*np.array(rows).T)


@pytest.fixture(scope="module")
def orbits() -> tuple[Orbit, Orbit]:
    return follow(64), follow(128)


def test_energy_and_angular_momentum_are_kept_for_twenty_turns(orbits):
    """They swing within a turn by the square of the interval, as held forces must, and do not drift."""
    coarse, fine = orbits
    energy, momentum = -0.5 * MU / AXIS, np.sqrt(MU * AXIS * (1.0 - ECCENTRICITY**2))
    swings = [
        (np.abs(orbit.energy / energy - 1.0).max(), np.abs(orbit.momentum / momentum - 1.0).max())
        for orbit in (coarse, fine)
    ]
    assert max(swings[1]) < 0.02
    assert np.all(np.array(swings[0]) > 3.0 * np.array(swings[1]))
    assert abs(coarse.drift()) < 1e-3
    assert abs(fine.drift()) < 1e-4


def test_the_period_is_keplers(orbits):
    """After twenty periods the pair is where it began, but for an angle that falls with the square of the interval."""
    coarse, fine = (abs(float(orbit.angle[-1])) / (2.0 * np.pi * TURNS) for orbit in orbits)
    assert coarse < 0.03
    assert 0.2 * coarse < fine < 0.35 * coarse
