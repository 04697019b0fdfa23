"""Where two bodies were when they touched."""

from dataclasses import dataclass

import numpy as np

from engine.scene.bodies import Sphere
from engine.scene.scene import Scene
from engine.scene.two_body import orbit


@dataclass(frozen=True)
class Contact:
    """State of two spheres when they touched; NaN when it is unknown.

    Attributes:
        offset: distance of the centres over the sum of the radii, less 1 [-].
        angle: between the relative velocity and the line of centres [deg].
    """

    offset: float
    angle: float


UNKNOWN = Contact(float("nan"), float("nan"))
"""Contact of bodies that are not two spheres, or have not touched."""


def contact_of(scene: Scene, time: float) -> Contact:
    """Return where the bodies of a scene are at a time, as point masses on their orbit from its start.

    Args:
        scene: what was simulated.
        time: when they touched [s].
    """
    spheres = [body for body in scene.bodies if isinstance(body, Sphere)]
    if not len(spheres) == len(scene.bodies) == 2 or not np.isfinite(time):
        return UNKNOWN
    first, second = spheres
    start = np.subtract(second.position, first.position), np.subtract(second.velocity, first.velocity)
    mass = first.mass + second.mass if scene.physics.gravity else 0.0
    position, velocity = orbit(*start, mass, time - scene.start_time)
    distance, across = float(np.linalg.norm(position)), float(np.linalg.norm(np.cross(position, velocity)))
    angle = float(np.degrees(np.arctan2(across, -position @ velocity)))
    return Contact(distance / (first.radius + second.radius) - 1.0, angle)
