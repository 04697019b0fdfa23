"""Small scenes in motion, for tests of the transfer."""

from typing import Any

import numpy as np

from engine.scene.bodies import Box
from engine.scene.scene import Numerics, Physics, Scene
from engine.simulation.simulation import Simulation
from tests.helpers.device import Array

RUBBLE = {"fracture": None, "gravity": None}


def body(**changes: Any) -> dict[str, Any]:
    """Fully damaged, unstressed, at rest."""
    return {"radius": 50e3, "particles": 100, "damage": 1.0, "hydrostatic": False, **changes}


def scene(*bodies: dict[str, Any], physics: dict[str, Any] = RUBBLE, **changes: Any) -> Scene:
    """Bodies without gravity and fracture, for longer than any test."""
    return Scene.model_validate({"bodies": bodies, "physics": physics, "end_time": 1e6, **changes})


def rubble_collision(**changes: Any) -> Scene:
    """Two turning bodies of unlike size that hit each other off centre."""
    target = body(position=(-40e3, 3e3, 0.0), velocity=(100.0, 0.0, 5.0), spin=(0.0, 1e-4, 3e-4))
    projectile = body(radius=40e3, particles=60, position=(52e3, 20e3, 5e3), velocity=(-200.0, 0.0, 0.0))
    return scene(target, projectile, **changes)


def box_scene(velocity: tuple[float, float, float] = (0.0, 0.0, 0.0), **physics: object) -> Scene:
    """A block of 8 x 4 x 4 cells of 1 m, periodic along x, one particle a cell."""
    body = Box(size=(8.0, 4.0, 4.0), lattice=(8, 4, 4), position=(4.0, 2.0, 2.0), velocity=velocity)
    parts = Physics.model_validate({"strength": False, "fracture": None, "gravity": None, **physics})
    return Scene(
        bodies=(body,),
        period=(8.0, None, None),
        end_time=0.02,
        physics=parts,
        numerics=Numerics(particles_per_cell=1.0),
    )


def started(given: Scene, **state: Array) -> Simulation:
    simulation = Simulation(given)
    simulation.start(**state)
    return simulation


def advance(simulation: Simulation, steps: int) -> Simulation:
    """At least this many steps."""
    while simulation.step < steps:
        assert not simulation.finished
        simulation.advance(simulation.scene.end_time)
    return simulation


def one_step(simulation: Simulation) -> float:
    """Take one step; returns its length [s]."""
    before = simulation.step
    simulation.clock.pause_time[None] = simulation.scene.end_time
    simulation.transfer.step()
    assert simulation.step == before + 1
    return float(simulation.clock.dt[None])


def spline(u: Array) -> Array:
    """Quadratic B-spline."""
    u = np.abs(u)
    return np.asarray(np.select([u < 0.5, u < 1.5], [0.75 - u**2, 0.5 * (1.5 - u) ** 2], 0.0))
