"""The state at the start: where particles are, how they move, how far gravity has compressed them."""

import numpy as np
from numpy.typing import NDArray

from engine.constants import G_NEWTON
from engine.laws.flaws import Flaws, draw_flaws, join
from engine.scene.bodies import Body, Box, Sphere
from engine.scene.placement import box_points, sphere_points
from engine.scene.scene import Scene
from engine.state.particles import Arrays

Vector = NDArray[np.float64]


def generator(scene: Scene, body: int, purpose: int) -> np.random.Generator:
    """The source of randomness for one purpose (0 positions, 1 flaws) of one body."""
    return np.random.default_rng([scene.seed, body, purpose])


def initial_state(scene: Scene) -> Arrays:
    """Every particle field that is not zero at the start, bodies one after the other."""
    parts = [_body_state(scene, i) for i in range(len(scene.bodies))]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def all_flaws(scene: Scene) -> Flaws:
    """Flaws of all particles; the scene must have fracture."""
    assert scene.physics.fracture is not None
    rule = scene.physics.fracture
    return join([draw_flaws(body, rule, generator(scene, i, 1)) for i, body in enumerate(scene.bodies)])


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


def _points(scene: Scene, index: int, body: Sphere | Box) -> NDArray[np.float64]:
    """Positions relative to the centre [m], shape [particle_count, 3]."""
    if isinstance(body, Box):
        return box_points(body.lattice, body.size)
    return sphere_points(body.particles, body.radius, generator(scene, index, 0))


def _hydrostatic_pressure(body: Sphere, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """P(r) = (2/3) pi G rho^2 (R^2 - r^2) [Pa] (engine/physics.md, section 8)."""
    square = np.einsum("ij,ij->i", points, points)
    pressure = 2.0 / 3.0 * np.pi * G_NEWTON * body.material.rho0**2 * np.maximum(body.radius**2 - square, 0.0)
    return np.asarray(pressure)


def _spin_tensor(body: Body) -> NDArray[np.float64]:
    """Velocity gradient [1/s] of rigid rotation."""
    x, y, z = body.spin
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
