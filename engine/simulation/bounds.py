"""Bounds that follow from a scene and the energies it starts with (engine/physics.md, section 13)."""

import math

import numpy as np
from scipy.optimize import brentq

from engine.constants import G_NEWTON
from engine.scene.material import Material
from engine.scene.scene import Scene
from engine.simulation.conservation import Row

LARGEST_COMPRESSION = 1e6
"""Bounds of rho/rho0 beyond this are none."""


def speed_scale(scene: Scene, start: Row) -> float:
    """Speed [m/s] that the scene can give to all its matter, were every energy turned into motion.

    Args:
        scene: what is simulated.
        start: first row of its history.
    """
    bodies = 2.0 * max(float(np.linalg.norm(b.velocity) + np.linalg.norm(b.spin) * b.reach) for b in scene.bodies)
    energy = float(start["kinetic_energy"] + abs(start["internal_energy"]) + start["elastic_energy"])
    energy += _rounding(scene, start)
    return math.sqrt(bodies**2 + 2.0 * energy / float(start["mass"]) + _fall(scene) ** 2)


def _fall(scene: Scene) -> float:
    """Speed [m/s] that gravity can give: from rest to the centre of all mass in one softened ball, or all the time."""
    gravity = scene.physics.gravity
    if gravity:
        mass = sum(body.mass for body in scene.bodies)
        return math.sqrt(3.0 * G_NEWTON * mass / (gravity.softening * scene.spacing))
    pull = float(np.linalg.norm(scene.physics.uniform_gravity or 0.0))
    return pull * (scene.end_time - scene.start_time)


def compression_limit(material: Material, energy: float) -> float:
    """rho/rho0 at which cold compression has used up a specific energy [J/kg]; infinite if it never does."""

    def missing(log_eta: float) -> float:
        return material.eos.cold_energy(material.rho0, math.exp(log_eta)) - energy

    largest = math.log(LARGEST_COMPRESSION)
    return math.exp(brentq(missing, 0.0, largest)) if missing(largest) > 0.0 else math.inf


def energy_growth(scene: Scene, row: Row, start: Row) -> float:
    """Growth of the total energy as a share of all energies that can turn into one another [-].

    The total is that of one time, kinetic energy taken half a step ahead: the work of stress then changes nothing in
    it, and only the transfer does, which dissipates. Taken as it is, it would swing by up to omega dt/2 with the
    shortest waves. Growth that is smaller than the dissipation meanwhile does not show.

    Args:
        scene: what is simulated.
        row, start: a row of its history, and the first.
    """
    parts = ("kinetic_energy", "affine_kinetic_energy", "internal_energy", "elastic_energy", "gravitational_energy")
    scale = sum(abs(float(start[name])) for name in parts) + _rounding(scene, start)
    scale += abs(float(row["gravitational_energy"] - start["gravitational_energy"]))
    return (_total(row) - _total(start)) / scale


def _total(row: Row) -> float:
    return float(row["total_energy"] + row["half_step_work"])


def _rounding(scene: Scene, start: Row) -> float:
    """Energy [J] that is nothing: the last digit of what waves carry, for scenes that start without any."""
    speed = max(material.longitudinal_speed for material in scene.materials)
    return float(np.finfo(np.float64).eps) * float(start["mass"]) * speed**2


def momentum_drift(row: Row, start: Row) -> float:
    """Size of the change of the total momentum [kg m/s]."""
    return float(np.linalg.norm(row["momentum"] - start["momentum"]))


def keeps_momentum(scene: Scene) -> bool:
    """Whether nothing from outside pushes."""
    return not scene.physics.walls and not any(scene.physics.uniform_gravity or ())


def keeps_energy(scene: Scene) -> bool:
    """Whether the total is known.

    Not without internal energy, nor where matter falls along a periodic axis, and is lifted back each period.
    """
    pull = scene.physics.uniform_gravity or (0.0, 0.0, 0.0)
    falls = any(length and along for length, along in zip(scene.period, pull, strict=True))
    return scene.physics.energy and not falls
