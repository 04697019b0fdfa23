"""What a particle does in every transfer scheme: the impulse it gives to the grid, and its response to deformation."""

import taichi as ti
import taichi.math as tm

from engine.device.fields import allocate
from engine.device.tensors import norm_squared, unpack
from engine.gravity.interfaces import GravityField
from engine.laws.constitution import Constitution
from engine.mpm.interfaces import Boundary
from engine.mpm.spline import SECOND_MOMENT
from engine.mpm.stencil import within_margin
from engine.mpm.time_step import Limits, free_stress_gradient2
from engine.state.clock import FAULT_INVERTED, Clock
from engine.state.particles import Particles


@ti.data_oriented
class Response:
    """Impulse and deformation of one particle (engine/physics.md, section 1).

    Args:
        particles: state of the particles.
        constitution: laws of matter.
        gravity: acceleration of one particle.
        walls: boundary of space.
        clock: time step.
        dx: grid spacing [m].
    """

    def __init__(
        self,
        particles: Particles,
        constitution: Constitution,
        gravity: GravityField,
        walls: Boundary,
        clock: Clock,
        dx: float,
    ) -> None:
        self.particles, self.constitution, self.gravity = particles, constitution, gravity
        self.walls, self.clock = walls, clock
        self.dx = allocate(ti.f64)
        self.dx[None] = dx

    @ti.func
    def impulse(self, p, dx):
        """Return m t g and -t V0 tau/(m2 dx) [kg m/s]: what forces add in the time t between the middles of steps."""
        mass, time = self.particles.mass[p], self.clock.kick[None]
        volume = mass / self.constitution.rho0(p)
        return mass * (time * self.gravity.at(p)), -time * volume / (SECOND_MOMENT * dx) * unpack(self.particles.tau[p])

    @ti.func
    def deform(self, p, L, dx):
        """Deform particle p by dt L, with the velocity gradient L [1/s]; returns its limits."""
        v = self.particles.v[p]
        c, diffusivity = self.constitution.update(p, L, self.clock.dt[None])
        if not self.particles.j[p] > -1.0 or tm.isinf(self.particles.j[p]):
            self.clock.report_fault(FAULT_INVERTED, self.particles.index[p])
        gradient2 = ti.max(norm_squared(L), norm_squared(self.particles.C[p]), self._free_gradient2(p, dx))
        return Limits(c + v.norm(), gradient2, self.gravity.at(p).norm_sqr(), diffusivity)

    @ti.func
    def fly(self, p):
        """Accelerate particle p, which shares no node with another, freely: F, E and D rest, sym(C) = 0.

        A wall stops it one step before it would cross.
        """
        dt, C = self.clock.dt[None], self.particles.C[p]
        v = self.particles.v[p] + self.clock.kick[None] * self.gravity.at(p)
        self.particles.v[p] = self.walls.apply(self.particles.x[p] + dt * v, v)
        self.particles.C[p] = 0.5 * (C - C.transpose())

    @ti.func
    def move(self, p, time):
        """Move particle p with its velocity, and ask for new blocks once it might leave the nodes of its own."""
        x = self.particles.x[p] + time * self.particles.v[p]  # += would be atomic
        self.particles.x[p] = x
        if not within_margin(x / self.dx[None], self.particles.origin[p]):
            self.clock.report_moved_out()

    @ti.func
    def rest(self, p, dx):
        """Leave particle p, which shares no node with another, undeformed; returns its limits.

        They contain its signal speed, because the length of the step in which it meets others
        follows from the one before.
        """
        self.constitution.rest(p)
        speed = self.constitution.signal_speed(p) + self.particles.v[p].norm()
        return Limits(speed, self._free_gradient2(p, dx), 0.0, 0.0)

    @ti.func
    def _free_gradient2(self, p, dx):
        """Return the square [1/s^2] of the velocity gradient that the stress of particle p alone sets."""
        return free_stress_gradient2(self.particles.tau[p], self.constitution.rho0(p), dx)
