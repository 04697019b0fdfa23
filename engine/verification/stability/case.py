"""One case of the matrix, and the scenes most of them are made of."""

from collections.abc import Callable
from dataclasses import dataclass

from engine.scene.bodies import Sphere
from engine.scene.collision import Collision
from engine.scene.material import Material, named
from engine.scene.scene import Physics, Scene
from engine.state.particles import Arrays
from engine.verification.harness import altered

Changes = Callable[[Scene], Arrays]
"""Returns fields of the initial state that replace those of a scene."""

PARTICLES = 100
"""Particles of a body."""

ROWS = 40
"""Rows of the history of a case."""


def as_it_is(scene: Scene) -> Arrays:
    """Change nothing in the initial state."""
    return {}


@dataclass(frozen=True)
class ExtremeCase:
    """A scene, the state from which it starts, and whether a guard may stop it.

    Attributes:
        group: what is extreme.
        name: how extreme.
        scene: what runs; valid, unless the case is beyond a limit that validation sets.
        changes: fields of the initial state that replace the scene's own.
        physical: whether matter and motion are possible and the settings accepted: then no guard may stop it.
    """

    group: str
    name: str
    scene: Scene
    changes: Changes = as_it_is
    physical: bool = True


def impact(
    velocity: float = 200.0, angle: float = 15.0, fraction: float = 1.0, radius: float = 50e3, **keys: object
) -> Scene:
    """Return a collision of two bodies until they could be two diameters apart, at most 2,000 s.

    Args:
        velocity: at contact [m/s].
        angle: impact angle [deg].
        fraction: of that time that is run [-].
        radius: of the target, and of the projectile unless it has its own [m].
        keys: other keys of the collision.
    """
    end_time = fraction * min(8.0 * radius / velocity, 2000.0)
    own = {"velocity": velocity, "angle": angle, "target": {"radius": radius}, "end_time": end_time}
    return with_rows(Collision.model_validate({"particles": PARTICLES, "start_separation": 1.1, **own, **keys}).scene())


def alone(end_time: float = 500.0, particles: int = PARTICLES, physics: Physics | None = None, **keys: object) -> Scene:
    """Return a scene of one sphere of R = 50 km without initial stress.

    Args:
        end_time: duration [s].
        particles: number of particles.
        physics: of the scene; by default all that a scene has.
        keys: other keys of the sphere.
    """
    body = Sphere.model_validate({"radius": 50e3, "particles": particles, "hydrostatic": False, **keys})
    return with_rows(Scene(bodies=(body,), end_time=end_time, physics=physics or Physics()))


def with_rows(scene: Scene) -> Scene:
    """Return the scene with `ROWS` equal intervals of the history and no snapshots."""
    interval = (scene.end_time - scene.start_time) / ROWS
    return altered(altered(scene, "output.history_interval", interval), "output.snapshot_interval", None)


def with_courant_number(scene: Scene, cfl: float) -> Scene:
    """Return the scene at another Courant number [-], also one that validation refuses."""
    return altered(scene, "numerics.cfl", cfl)


def in_single_precision(scene: Scene) -> Scene:
    """Return the scene in f32."""
    return altered(scene, "numerics.precision", "f32")


def stiffened(factor: float) -> Material:
    """Return basalt with its elastic moduli times a factor."""
    return named("basalt").slowed(factor**0.5)


def with_materials(scene: Scene, *materials: Material) -> Scene:
    """Return the scene with another material for each body."""
    bodies = zip(scene.bodies, materials, strict=True)
    return scene.model_copy(update={"bodies": tuple(b.model_copy(update={"material": m}) for b, m in bodies)})
