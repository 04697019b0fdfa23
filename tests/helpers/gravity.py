"""Particles at rest or in motion, and what self-gravity does to them where they are now."""

import numpy as np

from engine.constants import G_NEWTON
from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.self_gravity import SelfGravity
from engine.state.particles import Particles
from tests.helpers.device import Array


def particles_at(x: Array, mass: Array | None = None, v: Array | None = None) -> Particles:
    """Particles of mass 1/G_NEWTON, if none is given, at rest, if no velocity is given."""
    particles = Particles(len(x))
    masses = np.ones(len(x)) / G_NEWTON if mass is None else mass
    particles.write({"x": x, "mass": masses, "v": np.zeros_like(x) if v is None else v})
    return particles


def accelerations(solver: SelfGravity) -> Array:
    """Accelerations [m/s^2] of the solver's particles, shape [particle_count, 3]."""
    state = solver.particles.read("x", "mass")
    return solver.accelerations(state["x"], state["mass"])


def opened(tree: BarnesHut, opening: float) -> BarnesHut:
    """The same tree with another opening angle [-]: its kernels are compiled already."""
    tree.opening[None] = opening
    return tree


def energy(solver: SelfGravity) -> float:
    """Their gravitational energy [J]."""
    return solver.energy(np.zeros(3))


def energy_at(solver: SelfGravity, x: Array, mass: Array) -> float:
    """Their gravitational energy [J] at other positions [m]."""
    return 0.5 * float(np.sum(mass * solver.potentials(x, mass)))


def relative_error(solver: SelfGravity, exact: Array) -> Array:
    """Relative error of every acceleration, shape [particle_count]."""
    return np.asarray(lengths(accelerations(solver) - exact) / lengths(exact))


def lengths(vectors: Array) -> Array:
    """Euclidean norm of every row."""
    return np.asarray(np.sqrt((vectors**2).sum(axis=1)))


def cloud(count: int) -> tuple[Array, Array]:
    """Positions [m] and masses [kg] of a cloud of 10 km."""
    generator = np.random.default_rng(1)
    return 1e4 * generator.normal(size=(count, 3)), 1e12 * generator.uniform(0.1, 10.0, count)
