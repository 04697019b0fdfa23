"""Initial states that no scene has by itself: strained, expanding, hot, coincident."""

import numpy as np

from engine.constants import BLOCK_EDGE
from engine.mpm.blocks import HALF_RANGE
from engine.scene.scene import Scene
from engine.simulation.initial_conditions import initial_state
from engine.state.particles import Arrays
from engine.verification.stability.case import Changes


def strained(eta: float, damage: float = 0.0) -> Changes:
    """Condensed rock at rest at rho/rho0 = eta, with its stress and cold energy, at most that of evaporation."""

    def changes(scene: Scene) -> Arrays:
        material = scene.materials[0]
        intact = 1.0 if eta > 1.0 else 1.0 - damage
        energy = intact * min(material.eos.cold_energy(material.rho0, eta), 0.99 * material.eos.vaporisation_energy())
        tau = -intact * material.eos.pressure(material.rho0, eta - 1.0, energy) / eta
        return {
            # spacing at that density
            "x": initial_state(scene)["x"] * eta ** (-1.0 / 3.0),
            "j": np.full(scene.particles, 1.0 / eta - 1.0),
            "E": np.full(scene.particles, energy),
            "tau": np.tile([tau, tau, tau, 0.0, 0.0, 0.0], (scene.particles, 1)),
        }

    return changes


def expanding(rate: float) -> Changes:
    """Velocity H r; a negative H flows together."""

    def changes(scene: Scene) -> Arrays:
        x = initial_state(scene)["x"]
        return {"v": rate * x, "C": np.tile(rate * np.eye(3), (len(x), 1, 1))}

    return changes


def coincident(points: int) -> Changes:
    """All particles of all bodies at a few points."""

    def changes(scene: Scene) -> Arrays:
        x = initial_state(scene)["x"]
        return {"x": x[np.arange(len(x)) % points]}

    return changes


def barely_touching(scene: Scene) -> Arrays:
    """The second particle reaches the outermost node of the first with a weight of 1e-15, both under pressure."""
    # of the lowest nodes 0 and 2 of the two, node 2 is common; the weight of the second there is (4e-8)^2/2
    x = np.array([[0.6, 0.6, 0.6], [3.5 - 4e-8, 0.6, 0.6]])
    return {**strained(1.1)(scene), "x": x * scene.dx, "v": np.array([[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])}


def distant(distance: float) -> Changes:
    """The last body that far away [m] along a diagonal."""

    def changes(scene: Scene) -> Arrays:
        state = initial_state(scene)
        last = state["body"] == len(scene.bodies) - 1
        return {"x": state["x"] + np.outer(last, distance / np.sqrt(3.0) * np.ones(3))}

    return changes


def near_the_edge(scene: Scene) -> Arrays:
    """The second of two particles fifty cells inside the range of the grid."""
    return {"x": np.array([[0.0, 0.0, 0.0], [(BLOCK_EDGE * HALF_RANGE - 50.0) * scene.dx, 0.0, 0.0]])}


def one_hot(energy: float) -> Changes:
    """One particle [J/kg] amid cold ones."""

    def changes(scene: Scene) -> Arrays:
        values = np.zeros(scene.particles)
        values[np.argmin(np.linalg.norm(initial_state(scene)["x"], axis=1))] = energy
        return {"E": values}

    return changes


def random_motion(speed: float, rate: float) -> Changes:
    """Every particle with a velocity [m/s] and a velocity gradient [1/s] of its own."""

    def changes(scene: Scene) -> Arrays:
        generator, count = np.random.default_rng(scene.seed), scene.particles
        return {"v": speed * generator.normal(size=(count, 3)), "C": rate * generator.normal(size=(count, 3, 3))}

    return changes
