"""Affine particle-in-cell scheme: what a particle gives to the grid and takes from it (Jiang et al. 2015).

Equations in engine/physics.md, section 1.
"""

import taichi as ti
import taichi.math as tm

from engine.device.backend import EPSILON
from engine.device.tensors import determinant_increment, identity, norm_squared, symmetric, unpack
from engine.gravity.interfaces import GravityField
from engine.laws.constitution import Constitution
from engine.mpm.interfaces import Boundary
from engine.mpm.spline import SECOND_MOMENT
from engine.mpm.time_step import Limits, free_stress_gradient2
from engine.state.clock import FAULT_INVERTED, Clock
from engine.state.particles import Particles

ROUNDING = max(1e-9, 100.0 * EPSILON)
"""Relative difference of energies that are equal but for round-off."""


@ti.data_oriented
class Apic:
    """Momentum with its gradient, and stress by the moving-least-squares gradient.

    Args:
        particles: state of the particles.
        constitution: response of one particle.
        gravity: acceleration of one particle.
        walls: boundary of space.
        clock: time step.
    """

    def __init__(
        self, particles: Particles, constitution: Constitution, gravity: GravityField, walls: Boundary, clock: Clock
    ) -> None:
        self.particles, self.constitution, self.gravity = particles, constitution, gravity
        self.walls, self.clock = walls, clock

    def inertia(self, dx: float) -> float:
        """Return m2 dx^2 [m^2], with the second moment m2 of the spline."""
        return SECOND_MOMENT * dx**2

    @ti.func
    def momentum(self, p, dx):
        """Return m [kg], m (v + dt g) and m dx C - dt V0 tau/(m2 dx) [kg m/s]."""
        mass, dt = self.particles.mass[p], self.clock.dt[None]
        volume = mass / self.constitution.rho0(p)
        stress = dt * volume / (SECOND_MOMENT * dx) * unpack(self.particles.tau[p])
        affine = (mass * dx) * self.particles.C[p] - stress
        return mass, mass * (self.particles.v[p] + dt * self.gravity.at(p)), affine

    @ti.func
    def advance(self, p, v, L, dx):
        """Advance particle p with the mean velocity v of its nodes and deform it by dt L; returns its limits."""
        dt = self.clock.dt[None]
        self.particles.x[p] = self.particles.x[p] + dt * v  # += would be atomic
        self.particles.v[p] = v
        self.particles.C[p] = affine_velocity(L, dt, self.particles.j[p])
        c, diffusivity = self.constitution.update(p, L, dt)
        if not self.particles.j[p] > -1.0 or tm.isinf(self.particles.j[p]):
            self.clock.report_fault(FAULT_INVERTED, self.particles.index[p])
        gradient2 = ti.max(norm_squared(L), self.free_gradient2(p, dx))
        return Limits(c + v.norm(), gradient2, self.gravity.at(p).norm_sqr(), diffusivity)

    @ti.func
    def advance_ballistic(self, p, dx):
        """Advance particle p, which shares no node with another, freely: F, E and D rest, sym(C) = 0.

        A wall stops it one step before it would cross. The limits that are returned contain its speed and its speed of
        sound, because the step in which it meets others is as long as the one before.
        """
        dt = self.clock.dt[None]
        v = self.particles.v[p] + dt * self.gravity.at(p)
        v = self.walls.apply(self.particles.x[p] + dt * v, v)
        self.particles.x[p] = self.particles.x[p] + dt * v
        self.particles.v[p] = v
        self.particles.C[p] = 0.5 * (self.particles.C[p] - self.particles.C[p].transpose())
        return Limits(self.constitution.signal_speed(p) + v.norm(), self.free_gradient2(p, dx), 0.0, 0.0)

    @ti.func
    def free_gradient2(self, p, dx):
        """Return the square [1/s^2] of the velocity gradient that the stress of particle p alone sets."""
        return free_stress_gradient2(self.particles.tau[p], self.constitution.rho0(p), dx)


@ti.func
def affine_velocity(L, dt, j):
    """Return the affine velocity C [1/s] after a step, such that |sym C| max(J, 1)^(1/3) never increases.

    C = sym(L (I + dt L)^-1) + skew(L): the symmetric part is exact in isotropic flow, the skew part keeps angular
    momentum. Where the symmetric part would break the bound, as in compression of debris thinner than a cell, it is
    sym(L), divided by the growth of max(J, 1)^(1/3).

    Args:
        L: velocity gradient [1/s].
        dt: time step [s].
        j: det F - 1 before the step [-].
    """
    C, J = symmetric(L @ (identity() + dt * L).inverse()), 1.0 + j
    dilation = ti.max(J * (1.0 + determinant_increment(dt * L)), 1.0) / ti.max(J, 1.0)
    after, before = ti.cast(norm_squared(C), ti.f64), ti.cast(norm_squared(symmetric(L)), ti.f64)
    if not dilation**2 * after**3 <= (1.0 + ROUNDING) * before**3:  # sixth powers: single precision has no room
        C = symmetric(L) / ti.max(dilation, 1.0) ** (1.0 / 3.0)
    return C + 0.5 * (L - L.transpose())
