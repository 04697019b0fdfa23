"""A self-gravitating ellipsoid of rubble that spreads, turns or rests (engine/physics.md, sections 1, 4 and 7)."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from engine.arrays import Tensor, Vectors
from engine.scene.bodies import Sphere
from engine.scene.placement import sphere_points
from engine.scene.scene import Gravity, Physics, Scene
from engine.simulation.initial_conditions import Purpose, generator
from engine.state.particles import Arrays
from engine.verification.harness import Array, Harness, State
from engine.verification.problems.materials import elastic
from engine.verification.rubble_ellipsoid import Motion, RubbleEllipsoid

DENSITY = 2700.0
BULK = 2e9
"""Bulk modulus [Pa]: a thousand times the pressure, an eighth of basalt's, for steps 3.7 times as long."""
SHEAR = 0.6 * BULK


@dataclass(frozen=True)
class Lens:
    """An ellipsoid of particles with a linear velocity field.

    Attributes:
        start: its motion at t = 0.
        friction: coefficient mu_d [-].
        particles: number of particles.
        times: when it is compared [s].
    """

    start: Motion
    friction: float
    particles: int
    times: tuple[float, ...]

    @property
    def scene(self) -> Scene:
        """A sphere of the same volume, whose particles `fields` moves."""
        body = Sphere(
            radius=float(np.linalg.det(self.start.F) ** (1.0 / 3.0)),
            particles=self.particles,
            material=elastic(DENSITY, BULK, SHEAR, self.friction),
            damage=1.0,
            hydrostatic=False,
        )
        gravity = Gravity(softening=1.0, interval=20.0, opening=0.4)
        return Scene(bodies=(body,), end_time=self.times[-1], physics=Physics(fracture=None, gravity=gravity))

    @property
    def rubble(self) -> RubbleEllipsoid:
        """The same body without elastic strain."""
        return RubbleEllipsoid(self.scene.bodies[0].mass, DENSITY, self.friction)

    def fields(self) -> Arrays:
        """Return the state at t = 0, with the pressure and friction of the exact solution."""
        x, L = self._points(), self.start.L
        B = np.linalg.inv(self.start.F @ self.start.F.T)
        P = self.rubble.pressure(self.start) * np.maximum(1.0 - np.einsum("pi,ij,pj->p", x, B, x), 0.0)
        J = 1.0 / (1.0 + P / BULK)
        ratio = self.friction * self.start.flow
        values, axes = np.linalg.eigh(ratio)
        strain = np.expm1(np.outer(J * P, values) / SHEAR)
        return {
            "x": x,
            "v": x @ L.T,
            "C": np.tile(L, (len(x), 1, 1)),
            "j": J - 1.0,
            "b_minus_I": _packed(np.einsum("ik,pk,jk->pij", axes, strain, axes)),
            "tau": _packed((J * P)[:, None, None] * (ratio - np.eye(3))),
        }

    def run(self, harness: Harness) -> Iterator[State]:
        """Yield the state at each of the times."""
        simulation = harness.start(self.scene, **self.fields())
        for time in self.times:
            yield harness.run_until(simulation, time)

    def _points(self) -> Vectors:
        """Points of a face-centred lattice inside the ellipsoid [m], centred on their mean, shape [particles, 3]."""
        scene, longest = self.scene, 0.5 * self.start.axes[0]
        volume = 4.0 / 3.0 * np.pi * float(np.linalg.det(self.start.F))
        radius = 1.1 * longest
        count = round(self.particles * 4.0 / 3.0 * np.pi * radius**3 / volume)
        points = sphere_points(count, radius, generator(scene, 0, Purpose.POSITIONS))
        distance = np.linalg.norm(points @ np.linalg.inv(self.start.F).T, axis=1)
        chosen = points[np.sort(np.argsort(distance, kind="stable")[: self.particles])]
        return np.asarray(chosen - chosen.mean(axis=0))


def gradient(values: Array, x: Vectors) -> Tensor:
    """Return the matrix M that fits values = M x best, by least squares, shape [3, 3]; x has zero mean."""
    return np.linalg.lstsq(x, values, rcond=None)[0].T


def _packed(T: Array) -> Array:
    """Return the components xx, yy, zz, yz, zx, xy of symmetric tensors, shape [..., 6]."""
    return T[..., [0, 1, 2, 1, 2, 0], [0, 1, 2, 2, 0, 1]]
