"""Initial conditions: positions, motion and hydrostatic compression of all bodies (engine/physics.md, section 8)."""

from enum import IntEnum

import numpy as np

from engine.arrays import Scalars, Tensor, Vectors
from engine.constants import G_NEWTON
from engine.laws.flaws import Flaws, draw_flaws, join
from engine.scene.bodies import Body, Box, Sphere
from engine.scene.placement import box_points, sphere_points
from engine.scene.scene import Scene
from engine.state.particles import Arrays


class Purpose(IntEnum):
    """What random numbers are drawn for; the number is part of the seed."""

    POSITIONS = 0
    FLAWS = 1


def generator(scene: Scene, body: int, purpose: Purpose) -> np.random.Generator:
    """Return the random numbers for one purpose of one body, independent of all others.

    Args:
        scene: has the seed.
        body: index of the body.
        purpose: what they are drawn for.
    """
    return np.random.default_rng([scene.seed, body, purpose])


def initial_state(scene: Scene) -> Arrays:
    """Return every particle field that is not zero at the start, shape [particle_count, ...], body after body."""
    parts = [_body_state(scene, i) for i in range(len(scene.bodies))]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def all_flaws(scene: Scene) -> Flaws:
    """Return the flaws of all particles of a scene with fracture, body after body."""
    assert scene.physics.fracture is not None
    rule = scene.physics.fracture
    return join([draw_flaws(body, rule, generator(scene, i, Purpose.FLAWS)) for i, body in enumerate(scene.bodies)])


def _body_state(scene: Scene, index: int) -> Arrays:
    body = scene.bodies[index]
    points, pressure = _points(scene, index, body), np.zeros(body.count)
    if isinstance(body, Sphere) and body.hydrostatic:
        pressure = _hydrostatic_pressure(body, points)
    material = scene.materials[index]
    mu, energy = material.eos.compression_at(pressure, material.rho0, scene.physics.energy)
    return {
        "x": points + np.array(body.position),
        "v": np.array(body.velocity) + np.cross(np.array(body.spin), points),
        "C": np.tile(_spin_tensor(body), (body.count, 1, 1)),
        "j": -mu / (1.0 + mu),
        "E": energy,
        "tau": np.outer(-pressure / (1.0 + mu), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
        "damage_root": np.full(body.count, body.damage ** (1.0 / 3.0)),
        "mass": np.full(body.count, body.mass / body.count),
        "body": np.full(body.count, index, dtype=np.int32),
    }


def _points(scene: Scene, index: int, body: Sphere | Box) -> Vectors:
    """Positions relative to the centre [m], shape [particle_count, 3]."""
    if isinstance(body, Box):
        return box_points(body.lattice, body.size)
    return sphere_points(body.particles, body.radius, generator(scene, index, Purpose.POSITIONS))


def _hydrostatic_pressure(body: Sphere, points: Vectors) -> Scalars:
    """P(r) = (2/3) pi G rho^2 (R^2 - r^2) [Pa] (engine/physics.md, section 8)."""
    square = np.einsum("ij,ij->i", points, points)
    pressure = 2.0 / 3.0 * np.pi * G_NEWTON * body.material.rho0**2 * np.maximum(body.radius**2 - square, 0.0)
    return np.asarray(pressure)


def _spin_tensor(body: Body) -> Tensor:
    """Velocity gradient [1/s] of rigid rotation."""
    x, y, z = body.spin
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
