"""The scene that is timed: a collision of two bodies, from shortly before contact."""

from typing import Any

from engine.device.options import chosen
from engine.scene.collision import Collision
from engine.scene.scene import Contact, Gravity, Numerics, Scene

DEFAULT = Contact()


def collision(
    particles: int,
    gravity: Gravity | None = None,
    start_separation: float = 1.05,
    contact: Contact | None = DEFAULT,
    **numerics: Any,
) -> Scene:
    """A (200 m/s, 15 deg) collision of two bodies of `particles` each, with all physics but, unless asked, gravity."""
    return Collision(
        velocity=200.0,
        angle=15.0,
        particles=particles,
        gravity=gravity,
        contact=contact,
        start_separation=start_separation,
        end_time=1e5,
        numerics=Numerics(precision=chosen(), **numerics),
    ).scene()
