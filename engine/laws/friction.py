"""Friction of broken rock by the direction of its shear stress (engine/physics.md, section 4).

Every law gives the largest sqrt(J2)/P. Its coefficient mu is that of triaxial compression, where the laws are the same.
"""

from collections.abc import Callable

import taichi as ti
import taichi.math as tm

from engine.device.backend import Real
from engine.device.elementary import acos, asin, cos, power, sin
from engine.device.tensors import norm_squared
from engine.laws.interfaces import FrictionLaw


@ti.func
def lode_parameter(s):
    """Return -(3 sqrt(3)/2) det(s)/J2^(3/2): 1 in triaxial compression, 0 in pure shear, -1 in extension.

    1 where there is no shear.

    Args:
        s: deviatoric stress or strain, positive in tension.
    """
    J2, result = 0.5 * norm_squared(s), ti.cast(1.0, Real)
    if J2 > 0.0:
        result = tm.clamp(-1.5 * tm.sqrt(3.0) * (s / ti.sqrt(J2)).determinant(), -1.0, 1.0)
    return result


@ti.data_oriented
class DruckerPrager:
    """A circular cone: the same in all directions (Drucker & Prager 1952)."""

    @ti.func
    def coefficient(self, mu, s):
        """Return mu."""
        return mu


@ti.data_oriented
class MohrCoulomb:
    """A hexagonal cone: the largest ratio of shear to normal stress on any plane is tan(phi)."""

    @ti.func
    def coefficient(self, mu, s):
        """Return sin(phi)/(cos(th) - sin(th) sin(phi)/sqrt(3)), sin(3 th) the Lode parameter."""
        sine = 3.0 * mu / (2.0 * tm.sqrt(3.0) + mu)
        theta = asin(lode_parameter(s)) / 3.0
        return sine / (cos(theta) - sin(theta) * sine / tm.sqrt(3.0))


@ti.data_oriented
class MatsuokaNakai:
    """A smooth cone through the edges of Mohr and Coulomb's: I1 I2/I3 is constant (Matsuoka & Nakai 1974)."""

    @ti.func
    def coefficient(self, mu, s):
        """Return r, of which y = 1/r is the largest root of y^3 - 3 a y + 2 b = 0.

        With k = I1 I2/I3 at the limit and the Lode parameter l: a = (k - 3)/(3 (k - 9)), b = k l/(3 sqrt(3) (k - 9)).
        """
        result = ti.cast(0.0, Real)
        if mu > 0.0:
            rest = 1.0 - mu**2 + 2.0 / (3.0 * tm.sqrt(3.0)) * mu**3
            excess = mu**2 * (6.0 - 2.0 * tm.sqrt(3.0) * mu) / rest  # k - 9
            a = (excess + 6.0) / (3.0 * excess)
            b = (excess + 9.0) * lode_parameter(s) / (3.0 * tm.sqrt(3.0) * excess)
            result = 0.5 / (ti.sqrt(a) * cos(acos(tm.clamp(-b / power(a, 1.5), -1.0, 1.0)) / 3.0))
        return result


FRICTION_LAWS: dict[str, Callable[[], FrictionLaw]] = {
    "drucker-prager": DruckerPrager,
    "mohr-coulomb": MohrCoulomb,
    "matsuoka-nakai": MatsuokaNakai,
}
"""Laws by the name that a material gives."""
