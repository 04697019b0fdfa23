"""Growth of damage from active flaws (engine/physics.md, section 5; Grady & Kipp 1980, Benz & Asphaug 1994)."""

from collections.abc import Sequence

import taichi as ti

from engine.device.backend import Real
from engine.device.elementary import cbrt
from engine.device.fields import filled, per_body
from engine.device.tensors import largest_eigenvalue, norm_squared
from engine.laws.flaws import Flaws
from engine.scene.bodies import Body
from engine.scene.material import FractureRules, Material


@ti.data_oriented
class Fracture:
    """Growth of damage under tension that activates flaws.

    Args:
        bodies: bodies of the scene, in order.
        rule: rules of the parameter set.
        flaws: activation strains of every particle.
    """

    def __init__(self, bodies: Sequence[Body], rule: FractureRules, flaws: Flaws) -> None:
        self.per_flaw = rule.per_flaw
        self.table = per_body(
            modulus=[_strain_modulus(rule, body.material) for body in bodies],
            rate=[_growth_rate(rule, body) for body in bodies],
        )
        self.first = filled(ti.i32, flaws.first)
        self.strain = filled(Real, flaws.strain)

    @ti.func
    def grow(self, root, s, P, dt, number, body):
        """Return root + n rate dt, at most (n_open / n_all)^(1/3), where a flaw of the particle is active.

        n is the number of active flaws, or 1, by the rule of the parameter set.
        """
        m = self.table[body]
        result, first, total = root, self.first[number], self.first[number + 1] - self.first[number]
        if root < 1.0 and total > 0:
            # no eigenvalue of a deviator exceeds sqrt(2/3) of its norm: most particles are far from their first flaw
            bound = ti.sqrt(2.0 / 3.0 * norm_squared(s)) - P
            if bound >= self.strain[first] * m.modulus:
                active = self._active((largest_eigenvalue(s) - P) / m.modulus, number)
                if active > 0:
                    cracks = active if ti.static(self.per_flaw) else 1
                    cap = cbrt(ti.cast(active, Real) / total)
                    result = ti.max(root, ti.min(root + cracks * m.rate * dt, cap))
        return result

    @ti.func
    def _active(self, strain, number):
        """Number of flaws of a particle that are active at a strain [-]."""
        flaw, end = self.first[number], self.first[number + 1]
        while flaw < end and self.strain[flaw] < strain:
            flaw += 1
        return flaw - self.first[number]


@ti.data_oriented
class Unbreakable:
    """Constant damage."""

    @ti.func
    def grow(self, root, s, P, dt, number, body):
        """Return `root`."""
        return root


def _growth_rate(rule: FractureRules, body: Body) -> float:
    """Growth rate of the cube root of damage by one crack [1/s]: crack speed over the range of growth."""
    crack_speed = rule.growth_speed * body.material.longitudinal_speed
    return crack_speed / (rule.growth_range * body.spacing)


def _strain_modulus(rule: FractureRules, material: Material) -> float:
    """Modulus [Pa]: largest tensile stress over local strain."""
    return material.young_modulus if rule.strain == "young" else material.longitudinal_modulus
