"""Bounds that follow from a scene and the energies it starts with (engine/physics.md, section 13)."""

import math

import numpy as np
from scipy.optimize import brentq

from engine.arrays import Vector
from engine.constants import G_NEWTON
from engine.scene.material import Material
from engine.scene.scene import Scene
from engine.simulation.conservation import Row

LEAST_ENERGY_CHANGE = 1e-3
"""Change of the total energy that a run without shocks may have, in the measure of `energy_growth` [-]."""

SHOCK_ENERGY_CHANGE = 2e-2
"""The same of a run of any speed in many particles."""

LARGEST_COMPRESSION = 1e6
"""Compression rho/rho0 [-] above which a bound counts as infinite."""


def speed_scale(scene: Scene, start: Row) -> float:
    """Return the speed [m/s] of all matter if every energy of the start became kinetic.

    Args:
        scene: what is simulated.
        start: first row of its history.
    """
    bodies = 2.0 * _fastest(scene, np.zeros(3))
    energy = float(start["kinetic_energy"] + abs(start["internal_energy"]) + start["elastic_energy"])
    energy += _rounding(scene, start)
    return math.sqrt(bodies**2 + 2.0 * energy / float(start["mass"]) + _fall(scene) ** 2)


def _fastest(scene: Scene, frame: Vector) -> float:
    """Highest speed [m/s] of the surface of a body, rotation included, in a frame that moves at a velocity [m/s]."""
    return max(float(np.linalg.norm(b.velocity - frame) + np.linalg.norm(b.spin) * b.reach) for b in scene.bodies)


def _fall(scene: Scene) -> float:
    """Speed [m/s] that gravity can add.

    Self-gravity: of a fall from rest at infinity to the centre of one ball that has all mass and the softening radius.
    Uniform gravity: of a fall for the whole simulated time.
    """
    gravity = scene.physics.gravity
    if gravity:
        mass = sum(body.mass for body in scene.bodies)
        return math.sqrt(3.0 * G_NEWTON * mass / (gravity.softening * scene.spacing))
    pull = float(np.linalg.norm(scene.physics.uniform_gravity or 0.0))
    return pull * (scene.end_time - scene.start_time)


def speed_of_motion(scene: Scene) -> float:
    """Return the speed v_m [m/s] at which bodies meet, with rotation and self-gravity (physics.md, section 1).

    Args:
        scene: what is simulated.
    """
    mass = np.array([body.mass for body in scene.bodies])
    bodies = 2.0 * _fastest(scene, mass @ np.array([body.velocity for body in scene.bodies]) / mass.sum())
    volume = sum(body.volume for body in scene.bodies)
    radius = (0.75 * volume / math.pi) ** (1.0 / 3.0)
    escape = math.sqrt(2.0 * G_NEWTON * float(mass.sum()) / radius) if scene.physics.gravity else 0.0
    return math.hypot(bodies, escape)


def compression_limit(material: Material, energy: float) -> float:
    """Return rho/rho0 [-] at which the cold energy of compression equals a given energy; infinite if it never does.

    Args:
        material: has the equation of state.
        energy: specific energy [J/kg].
    """

    def missing(log_eta: float) -> float:
        return material.eos.cold_energy(material.rho0, math.exp(log_eta)) - energy

    largest = math.log(LARGEST_COMPRESSION)
    return math.exp(brentq(missing, 0.0, largest)) if missing(largest) > 0.0 else math.inf


def largest_energy_change(scene: Scene) -> float:
    """Return the largest change of the total energy in the measure of `energy_growth` [-].

    It is of second order in the size of cells, (dx/R)^2/15 of a sphere with as many particles as the smallest body. As
    it is not behind shocks, it is at least 1e-3 (1 + v_m/c_l), or 2e-2 if that is less. All energy of a body of one
    particle may be in its breathing at 2c/dx, whose energy a leapfrog step of cfl dx/c changes by cfl^2.

    Args:
        scene: what is simulated.
    """
    fewest = min(body.count for body in scene.bodies)
    cell = (4.0 / 3.0 * math.pi * scene.numerics.particles_per_cell / fewest) ** (1.0 / 3.0)
    breathing = scene.numerics.cfl**2 if fewest == 1 else 0.0
    mach = speed_of_motion(scene) / min(material.longitudinal_speed for material in scene.materials)
    return float(max(cell**2 / 15.0, breathing, min(LEAST_ENERGY_CHANGE * (1.0 + mach), SHOCK_ENERGY_CHANGE)))


def energy_growth(scene: Scene, row: Row, start: Row) -> float:
    """Return the growth of the total energy relative to the sum of all energies [-].

    Args:
        scene: what is simulated.
        row, start: a row of its history, and the first.
    """
    parts = ("kinetic_energy", "affine_kinetic_energy", "internal_energy", "elastic_energy", "gravitational_energy")
    scale = sum(abs(float(start[name])) for name in parts) + _rounding(scene, start)
    scale += abs(float(row["gravitational_energy"] - start["gravitational_energy"]))
    return float(row["total_energy"] - start["total_energy"]) / scale


def _rounding(scene: Scene, start: Row) -> float:
    """Round-off of the energy of sound, epsilon m c^2 [J]: the scale of energy of a scene that starts without any."""
    speed = max(material.longitudinal_speed for material in scene.materials)
    return float(np.finfo(np.float64).eps) * float(start["mass"]) * speed**2


def momentum_drift(row: Row, start: Row) -> float:
    """Return the magnitude of the change of the total momentum [kg m/s] between the first row and another."""
    return float(np.linalg.norm(row["momentum"] - start["momentum"]))


def keeps_momentum(scene: Scene) -> bool:
    """Whether total momentum is conserved: neither walls nor uniform gravity act."""
    return not scene.physics.walls and not any(scene.physics.uniform_gravity or ())


def dissipates(scene: Scene) -> bool:
    """Whether total energy falls: walls take energy, and the transfer `apic` keeps no account of what it takes."""
    return bool(scene.physics.walls) or scene.numerics.transfer == "apic"


def keeps_energy(scene: Scene) -> bool:
    """Whether total energy is conserved but for what `dissipates`.

    It is not without internal energy, nor with uniform gravity along a periodic axis: matter that leaves at the lower
    end enters again at the upper one.
    """
    pull = scene.physics.uniform_gravity or (0.0, 0.0, 0.0)
    falls = any(length and along for length, along in zip(scene.period, pull, strict=True))
    return scene.physics.energy and not falls
