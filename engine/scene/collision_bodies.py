"""The two spheres of a collision as a study gives them (engine/physics.md, section 8)."""

from typing import Annotated

import numpy as np
from pydantic import Field

from engine.scene.bodies import Damage
from engine.scene.fields import Frozen, Number, OrOff, Positive, Vector, key

MaterialName = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$")]


class CollisionBody(Frozen):
    """What target and projectile have in common."""

    damage: Annotated[Damage, key("damage at the start; 1 is rubble", "1")] = 0.0
    spin_period: Annotated[OrOff[Positive], key("rotation period at the start; false for no spin", "hour")] = None
    spin_obliquity: Annotated[
        Number,
        Field(ge=0.0, le=180.0),
        key("angle of the spin from the angular momentum of the impact, 0 prograde, 180 retrograde", "degree"),
    ] = 0.0

    @property
    def spin(self) -> Vector:
        """Angular velocity [rad/s]: 2 pi/period about (sin e, 0, cos e), tilted from +z towards +x."""
        if self.spin_period is None:
            return 0.0, 0.0, 0.0
        rate, tilt = 2.0 * np.pi / (3600.0 * self.spin_period), np.deg2rad(self.spin_obliquity)
        x, z = (rounded(rate * round(float(part), 12)) for part in (np.sin(tilt), np.cos(tilt)))
        return x, 0.0, z


class Target(CollisionBody):
    """The first body."""

    material: Annotated[MaterialName, key("material of the target")] = "basalt"
    radius: Annotated[Positive, key("radius of the target", "m")] = 50.0e3


class Projectile(CollisionBody):
    """The second body; its material and radius are the target's where they are not given."""

    material: Annotated[MaterialName | None, key("material of the projectile; by default the target's")] = None
    radius: Annotated[Positive | None, key("radius of the projectile; by default the target's", "m")] = None


def rounded(value: float) -> float:
    """Ten digits of a number: the same collision is then the same scene, and the same job, on every machine."""
    return float(f"{value:.9e}") + 0.0  # -0.0 + 0.0 is 0.0, as in a scene that was read
