"""The same state stepped the usual way, and how far it then is from the engine's."""

from collections.abc import Sequence

import numpy as np

from engine.laws.constitution import Constitution
from engine.simulation import assembly
from engine.simulation.simulation import Simulation
from engine.state.particles import Arrays, Particles
from tests.benchmarks.contact import take_step
from tests.benchmarks.dense import DenseTransfer
from tests.benchmarks.stretch import StretchConstitution

QUANTITIES = ("x", "v", "J", "damage")
ROUND_OFF = 1e-13
"""Largest difference after 20 steps on the usual grid, in units of dx, of the largest speed, and of 1."""
ROUND_OFF_SVD = 1e-8
"""The same with `ti.svd`, from which each particle that yields is rebuilt: U S V^T is F to 2e-10, near I to 2e-7."""


def baseline(simulation: Simulation) -> DenseTransfer:
    """The usual way, with a singular value decomposition, from the state of `simulation`."""
    return _dense(simulation, StretchConstitution)


def dense_grid_only(simulation: Simulation) -> DenseTransfer:
    """The usual grid with the engine's own constitution, from the state of `simulation`."""
    return _dense(simulation, Constitution)


def _dense(simulation: Simulation, kind: type[Constitution]) -> DenseTransfer:
    scene, particles = simulation.scene, Particles(simulation.particles.count)
    own, gravity = assembly.constitution(scene, particles), assembly.gravity(scene, particles)
    particles.write(simulation.particles.read())
    parts = (own.eos, own.energy, own.dissipation, own.packing, own.shear, own.damage, own.viscosity)
    return DenseTransfer(particles, kind(particles, *parts), gravity, scene.dx)


def differences(simulation: Simulation, other: DenseTransfer) -> dict[str, float]:
    """Largest difference of any particle, in units of dx, of the largest speed, and of 1."""
    here, there = _outcome(simulation.particles), _outcome(other.particles)
    if isinstance(other.constitution, StretchConstitution):
        there["J"] = other.constitution.volume_ratio()
    scale = {"x": simulation.scene.dx, "v": float(np.abs(here["v"]).max())}
    return {name: float(np.abs(here[name] - there[name]).max()) / scale.get(name, 1.0) for name in QUANTITIES}


def _outcome(particles: Particles) -> Arrays:
    state = particles.read("x", "v", "j", "damage_root")
    return {"x": state["x"], "v": state["v"], "J": 1.0 + state["j"], "damage": state["damage_root"] ** 3}


def step_together(simulation: Simulation, others: Sequence[DenseTransfer], steps: int) -> None:
    """Advance all by the same time steps."""
    for _ in range(steps):
        dt = take_step(simulation)
        for other in others:
            other.step(dt, float(simulation.clock.kick[None]))
