"""How loosely broken rock is packed: dilatancy towards a critical state, or none (engine/physics.md, section 4)."""

from collections.abc import Sequence

import taichi as ti

from engine.device.backend import Real
from engine.device.elementary import exp
from engine.device.fields import per_body
from engine.scene.material import Material
from engine.state.particles import Particles


@ti.data_oriented
class CriticalState:
    """Rubble bears pressure below J = J_c, which shear moves towards a critical packing (Schofield & Wroth 1968).

    Args:
        particles: state of the particles.
        materials: one per body; those without a critical density stay as dense as rock.
    """

    def __init__(self, particles: Particles, materials: Sequence[Material]) -> None:
        self.plastic_dilation = particles.require("plastic_dilation")
        looseness = [material.rho0 / (material.critical_density or material.rho0) - 1.0 for material in materials]
        dilatancy = [material.dilatancy or 0.0 for material in materials]
        self.table = per_body(
            looseness=looseness,
            dilatancy=dilatancy,
            rate=[b / loose if loose else 0.0 for b, loose in zip(dilatancy, looseness, strict=True)],
            # of pressure, which makes the critical packing denser
            crushing=[
                1.0 / material.crushing_pressure if material.crushing_pressure else 0.0 for material in materials
            ],
        )

    @ti.func
    def dilation(self, p):
        """Return J_c - 1 [-] of particle p."""
        return self.plastic_dilation[p]

    @ti.func
    def friction(self, p, mu, P, body):
        """Return the friction coefficient of the packing: mu where it dilates most, less where it does so less."""
        m = self.table[body]
        return mu - m.dilatancy + m.rate * (self.critical(P, body) - self.plastic_dilation[p])

    @ti.func
    def shear(self, p, shear, J, P, Y, D, body):
        """Move the packing of particle p towards the critical one by a plastic shear [-].

        Where other things than friction limit the stress, dilatancy takes no more than the work of shear.
        """
        m, dilation, critical = self.table[body], self.plastic_dilation[p], self.critical(P, body)
        work = m.dilatancy * P
        if work > Y:
            shear *= Y / work
        dilation = critical + (dilation - critical) * exp(-m.rate * D * shear)
        if D == 1.0 and m.looseness < J - 1.0:
            dilation = m.looseness
        self.plastic_dilation[p] = dilation

    @ti.func
    def critical(self, P, body):
        """Return J_c - 1 [-] of the critical packing at a pressure [Pa]."""
        m = self.table[body]
        return m.looseness / (1.0 + ti.max(P, 0.0) * m.crushing)


@ti.data_oriented
class AsDenseAsRock:
    """Broken rock is as dense as it was."""

    @ti.func
    def dilation(self, p):
        """Return zero."""
        return ti.cast(0.0, Real)

    @ti.func
    def friction(self, p, mu, P, body):
        """Return mu."""
        return mu

    @ti.func
    def shear(self, p, shear, J, P, Y, D, body):
        """Do nothing."""
