"""Initial states that no scene has by itself: strained, expanding, hot, coincident."""

import numpy as np

from engine.arrays import Scalars
from engine.constants import BLOCK_EDGE
from engine.mpm.block_coordinates import HALF_RANGE
from engine.scene.scene import Scene
from engine.simulation.initial_conditions import initial_state
from engine.state.particles import Arrays
from engine.verification.stability.case import Changes


def strained(eta: float, damage: float = 0.0) -> Changes:
    """Strain rock uniformly: stress and cold energy at a density, the energy at most that of evaporation.

    Args:
        eta: rho/rho0 [-].
        damage: D of the scene, which reduces tension [-].
    """

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
    """Set the velocity to H r; H [1/s] is negative for a flow towards the centre."""

    def changes(scene: Scene) -> Arrays:
        x = initial_state(scene)["x"]
        return {"v": rate * x, "C": np.tile(rate * np.eye(3), (len(x), 1, 1))}

    return changes


def coincident(points: int) -> Changes:
    """Move all particles of all bodies to a few points."""

    def changes(scene: Scene) -> Arrays:
        x = initial_state(scene)["x"]
        return {"x": x[np.arange(len(x)) % points]}

    return changes


def barely_touching(scene: Scene) -> Arrays:
    """Place the second particle so that it gives a node of the first a weight of 1e-15, both under pressure."""
    # of the lowest nodes 0 and 2 of the two, node 2 is common; the weight of the second there is (4e-8)^2/2
    x = np.array([[0.6, 0.6, 0.6], [3.5 - 4e-8, 0.6, 0.6]])
    return {**strained(1.1)(scene), "x": x * scene.dx, "v": np.array([[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])}


def distant(distance: float) -> Changes:
    """Move the last body by a distance [m] along a diagonal."""

    def changes(scene: Scene) -> Arrays:
        state = initial_state(scene)
        last = state["body"] == len(scene.bodies) - 1
        return {"x": state["x"] + np.outer(last, distance / np.sqrt(3.0) * np.ones(3))}

    return changes


def near_the_edge(scene: Scene) -> Arrays:
    """Place the second of two particles fifty cells inside the range of the grid."""
    return {"x": np.array([[0.0, 0.0, 0.0], [(BLOCK_EDGE * HALF_RANGE - 50.0) * scene.dx, 0.0, 0.0]])}


def hot(energy: float) -> Changes:
    """Give every particle an energy [J/kg] at the density of the scene, and the pressure of that state."""

    def changes(scene: Scene) -> Arrays:
        return _heated(scene, energy, np.ones(scene.particles))

    return changes


def one_hot(energy: float) -> Changes:
    """Give one particle at the centre an energy [J/kg] and its pressure, and none to the others."""

    def changes(scene: Scene) -> Arrays:
        where = np.zeros(scene.particles)
        where[np.argmin(np.linalg.norm(initial_state(scene)["x"], axis=1))] = 1.0
        return _heated(scene, energy, where)

    return changes


def _heated(scene: Scene, energy: float, where: Scalars) -> Arrays:
    """Energy [J/kg] where it is 1 and none where it is 0, and the stress of matter at rest density that has it."""
    material = scene.materials[0]
    pressure = material.eos.pressure(material.rho0, 0.0, energy)
    return {"E": energy * where, "tau": np.outer(-pressure * where, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0])}


def random_motion(speed: float, rate: float) -> Changes:
    """Draw a velocity and a velocity gradient for every particle from normal distributions.

    Args:
        speed: standard deviation of each component of velocity [m/s].
        rate: that of each component of the gradient [1/s].
    """

    def changes(scene: Scene) -> Arrays:
        generator, count = np.random.default_rng(scene.seed), scene.particles
        return {"v": speed * generator.normal(size=(count, 3)), "C": rate * generator.normal(size=(count, 3, 3))}

    return changes
