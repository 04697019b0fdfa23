"""What self-gravity does to particles where they are now."""

from engine.gravity.self_gravity import SelfGravity
from tests.helpers.device import Array


def accelerations(solver: SelfGravity) -> Array:
    """Accelerations [m/s^2] of the solver's particles, shape [particle_count, 3]."""
    state = solver.particles.read("x", "mass")
    return solver.accelerations(state["x"], state["mass"])


def energy(solver: SelfGravity) -> float:
    """Their gravitational energy [J]."""
    state = solver.particles.read("x", "mass")
    return solver.energy(state["x"], state["mass"])
