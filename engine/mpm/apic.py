"""Affine particle-in-cell transfer (Jiang et al. 2015), to compare with (engine/physics.md, section 1)."""

from collections.abc import Callable

import taichi as ti

from engine.mpm.affine import affine_velocity
from engine.mpm.interfaces import Exchange, Stage
from engine.mpm.response import Response
from engine.mpm.spline import SECOND_MOMENT


@ti.data_oriented
class Apic:
    """One pass: particles take the velocity of the grid, and lose in every step what the grid cannot represent.

    Args:
        response: of one particle.
    """

    name = "apic"

    def __init__(self, response: Response) -> None:
        self.response, self.particles, self.clock = response, response.particles, response.clock
        self.nodes = response.walls

    def stages(self, over_grid: Callable[[Exchange], Stage]) -> tuple[Stage, ...]:
        """Return the only pass."""
        return (over_grid(self),)

    def inertia(self, dx: float) -> float:
        """Return m2 dx^2 [m^2], with the second moment m2 of the spline."""
        return SECOND_MOMENT * dx**2

    @ti.func
    def give(self, p, dx):
        """Return m [kg], m (v + t g) and m dx C - t V0 tau/(m2 dx) [kg m/s], with the time t in which forces act."""
        mass = self.particles.mass[p]
        momentum, affine = self.response.impulse(p, dx)
        return mass, mass * self.particles.v[p] + momentum, (mass * dx) * self.particles.C[p] + affine

    @ti.func
    def take(self, p, v, L, dx):
        """Advance particle p with the mean velocity v of its nodes and deform it by dt L; returns its limits."""
        dt = self.clock.dt[None]
        self.particles.v[p] = v
        self.response.move(p, dt)
        self.particles.C[p] = affine_velocity(L, dt, self.response.constitution.expansion(p), 1.0 / dt)
        return self.response.deform(p, L, dx)

    @ti.func
    def take_alone(self, p, dx):
        """Advance particle p freely; returns its limits."""
        self.response.fly(p)
        self.response.move(p, self.clock.dt[None])
        return self.response.rest(p, dx)
