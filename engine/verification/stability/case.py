"""One case of the matrix, and the scenes most of them are made of."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.scene.bodies import Sphere
from engine.scene.collision import Collision
from engine.scene.material import Material, named
from engine.scene.scene import Physics, Scene
from engine.state.particles import Arrays
from engine.verification.harness import altered

Changes = Callable[[Scene], dict[str, NDArray[Any]]]

PARTICLES = 100
"""Particles of a body."""
ROWS = 40
"""Rows of the history of a case."""


def as_it_is(scene: Scene) -> Arrays:
    """No change of the initial state."""
    return {}


@dataclass(frozen=True)
class Case:
    """A scene, the state it starts from, and whether it may be stopped.

    Attributes:
        group: what is extreme.
        name: how extreme.
        scene: what runs; a valid one unless a validated limit is what the case exceeds.
        changes: fields of the initial state that replace the scene's own.
        physical: matter and motion that can be, at settings that a scene accepts: must not be stopped.
    """

    group: str
    name: str
    scene: Scene
    changes: Changes = as_it_is
    physical: bool = True


def impact(
    velocity: float = 200.0, angle: float = 15.0, share: float = 1.0, radius: float = 50e3, **settings: Any
) -> Scene:
    """Two bodies of R = 50 km that meet, until they could be two diameters apart or 2,000 s are over.

    Args:
        velocity: at contact [m/s].
        angle: impact angle [deg].
        share: of that time.
        radius: of the target, and of the projectile unless it has its own [m].
        settings: of the collision.
    """
    end_time = share * min(8.0 * radius / velocity, 2000.0)
    own = {"velocity": velocity, "angle": angle, "target": {"radius": radius}, "end_time": end_time}
    chosen = {"particles": PARTICLES, "start_separation": 1.1, **settings}
    return with_rows(Collision.model_validate({**own, **chosen}).scene())


def alone(
    end_time: float = 500.0, particles: int = PARTICLES, physics: Physics | None = None, **settings: Any
) -> Scene:
    """One body of R = 50 km by itself, unstressed; settings are its own."""
    body = Sphere.model_validate({"radius": 50e3, "particles": particles, "hydrostatic": False, **settings})
    return with_rows(Scene(bodies=(body,), end_time=end_time, physics=physics or Physics()))


def with_rows(scene: Scene) -> Scene:
    """The scene with a row of the history for every part of its time, and no snapshots."""
    interval = (scene.end_time - scene.start_time) / ROWS
    return altered(altered(scene, "output.history_interval", interval), "output.snapshot_interval", None)


def with_courant_number(scene: Scene, cfl: float) -> Scene:
    """The scene at a time step that validation might refuse."""
    return altered(scene, "numerics.cfl", cfl)


def in_single_precision(scene: Scene) -> Scene:
    """The scene in f32."""
    return altered(scene, "numerics.precision", "f32")


def stiffened(factor: float) -> Material:
    """Basalt of other elastic moduli."""
    return named("basalt").slowed(factor**0.5)


def with_materials(scene: Scene, *materials: Material) -> Scene:
    """The scene with another material for each body."""
    bodies = zip(scene.bodies, materials, strict=True)
    return scene.model_copy(update={"bodies": tuple(b.model_copy(update={"material": m}) for b, m in bodies)})


def uniform(**values: float) -> Changes:
    """Fields that have the same value everywhere."""
    return lambda scene: {name: np.full(scene.particles, value) for name, value in values.items()}
