"""Pressure-dependent strength and friction as one radial return (engine/physics.md, section 4; Jutzi 2015)."""

from collections.abc import Sequence

import taichi as ti
import taichi.math as tm

from engine.device.backend import Real
from engine.device.fields import per_body
from engine.laws.friction import FRICTION_LAWS
from engine.laws.interfaces import PackingLaw
from engine.scene.material import Material


@ti.data_oriented
class Strength:
    """Largest sqrt(J2) of intact, damaged and partly damaged rock.

    Args:
        materials: one per body, of one law of friction.
        packing: of broken rock.
    """

    def __init__(self, materials: Sequence[Material], packing: PackingLaw) -> None:
        self.packing = packing
        self.friction = FRICTION_LAWS[materials[0].friction_law]()
        constants = ("cohesion", "intact_friction", "strength_limit", "melt_energy", "friction")
        self.table = per_body(**{name: [material.known(name) for material in materials] for name in constants})

    @ti.func
    def bears_shear(self, P, D):
        """Return whether rock is under pressure or not wholly damaged."""
        return P > 0.0 or D < 1.0

    @ti.func
    def limit(self, p, P, E, D, s, body):
        """Return Y = (1 - D) Y_i + D Y_d [Pa]."""
        m = self.table[body]
        confining = ti.max(P, 0.0)
        friction, rise = m.intact_friction * confining, m.strength_limit - m.cohesion
        intact = m.cohesion + friction * rise / (rise + friction)
        intact *= ti.min(ti.max(1.0 - E / m.melt_energy, 0.0), 1.0)
        mu = self.packing.friction(p, m.friction, P, body)
        damaged = ti.min(self.friction.coefficient(mu, s) * confining, intact)
        return (1.0 - D) * intact + D * damaged


@ti.data_oriented
class Unlimited:
    """Elasticity without yielding."""

    @ti.func
    def bears_shear(self, P, D):
        """Return true."""
        return True

    @ti.func
    def limit(self, p, P, E, D, s, body):
        """Return infinity."""
        return ti.cast(tm.inf, Real)


@ti.func
def return_factor(root_J2, Y):
    """Return the factor on the deviatoric strain of the radial return: 1 up to sqrt(J2) = Y, Y / sqrt(J2) beyond.

    Args:
        root_J2: sqrt(J2) of the trial stress [Pa].
        Y: largest sqrt(J2) [Pa].
    """
    factor = ti.cast(1.0, Real)
    if root_J2 > Y:
        factor = Y / root_J2
    return factor
