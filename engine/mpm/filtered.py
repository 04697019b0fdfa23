"""Filtered affine transfer: particles keep their own motion, of which the finest part decays at a rate.

A step kicks particles by the impulse of the grid, drifts for half of it, deforms them by the gradient of the projected
motion, filters the motion, and drifts for the other half. Equations in engine/physics.md, section 1.
"""

from collections.abc import Callable

import taichi as ti

from engine.device.backend import Real, mat3, vec3
from engine.device.fields import allocate, capacity
from engine.device.launches import Kernel
from engine.device.tensors import moved, norm_squared
from engine.mpm.affine import affine_velocity
from engine.mpm.interfaces import Boundary, Exchange, Stage
from engine.mpm.response import Response
from engine.mpm.spline import SECOND_MOMENT
from engine.mpm.time_step import no_limits
from engine.mpm.walls import NoWalls

Motion = ti.types.struct(v=vec3, C=mat3)
"""Velocity [m/s] and its gradient [1/s] of a particle: q = (v, C) of engine/physics.md, section 1."""


@ti.func
def product(a, b, dx):
    """Return the inner product v.v' + m2 dx^2 C:C' [m^2/s^2] of two motions."""
    return a.v.dot(b.v) + SECOND_MOMENT * dx * dx * (a.C * b.C).sum()


@ti.data_oriented
class Filtered:
    """Passes of a step: kick, wall if there are any, projection, and correction.

    Args:
        response: of one particle.
        rate: at which motion decays that the grid cannot represent [1/s].
        steepest: gradient of velocity above which the affine motion of a particle does not grow by itself [1/s].
        walled: whether there are walls.

    Attributes:
        kicked: change of the motion by forces in this step.
        remainder: part of the motion that its projection on the grid lacks, r = q - Pi q.
    """

    def __init__(self, response: Response, rate: float, steepest: float, walled: bool) -> None:
        self.response, self.particles, self.clock = response, response.particles, response.clock
        size = capacity(self.particles.count)
        self.kicked, self.remainder = allocate(Motion, size), allocate(Motion, size)
        self.rate, self.steepest = allocate(Real), allocate(Real)
        self.rate[None], self.steepest[None] = rate, steepest
        self.walled = walled

    def stages(self, over_grid: Callable[[Exchange], Stage]) -> tuple[Stage, ...]:
        """Return kick, wall contact if there are walls, drift, projection, correction and drift."""
        walls, free, drift = self.response.walls, NoWalls(), Drift(self)
        contact = (over_grid(WallContact(self, Change(walls))),) if self.walled else ()
        projection, correction = Projection(self, walls), Correction(self, free)
        return over_grid(Kick(self, free)), *contact, drift, over_grid(projection), over_grid(correction), drift

    def inertia(self, dx: float) -> float:
        """Return m2 dx^2 [m^2], with the second moment m2 of the spline."""
        return SECOND_MOMENT * dx**2

    @ti.func
    def scaled(self, p, motion, dx):
        """Return mass [kg], momentum and affine momentum [kg m/s] of particle p in a motion."""
        mass = self.particles.mass[p]
        return mass, mass * motion.v, mass * dx * motion.C

    @ti.func
    def motion(self, p):
        """Return the motion of particle p."""
        return Motion(self.particles.v[p], self.particles.C[p])

    @ti.func
    def change(self, p, v, C):
        """Add to the motion of particle p."""
        self.particles.v[p] = self.particles.v[p] + v
        self.particles.C[p] = self.particles.C[p] + C

    @ti.func
    def lose_affine(self, p, before, after):
        """Account for what particle p has lost of the energy of its affine motion by moving: it is no heat."""
        dx = ti.cast(self.response.dx[None], Real)
        loss = 0.5 * SECOND_MOMENT * dx * dx * (norm_squared(before) - norm_squared(after))
        self.response.constitution.dissipation.drift(p, loss)

    @ti.func
    def lose(self, p, heat):
        """Turn kinetic energy of particle p into heat [J/kg]."""
        self.response.constitution.lose_to_transfer(p, heat)


@ti.data_oriented
class MotionExchange:
    """Particles give their motion to the grid; one that shares no node stays as it is.

    Args:
        scheme: whose motion is exchanged.
        nodes: what acts on the nodes.
    """

    def __init__(self, scheme: Filtered, nodes: Boundary) -> None:
        self.scheme, self.nodes = scheme, nodes

    @ti.func
    def give(self, p, dx):
        """Return the mass and the motion of particle p."""
        return self.scheme.scaled(p, self.scheme.motion(p), dx)

    @ti.func
    def take_alone(self, p, dx):
        """Leave particle p, which is its own projection, as it is; sets no limits."""
        return no_limits()


@ti.data_oriented
class Kick(MotionExchange):
    """Forces: q <- q + gather(impulse/mass of the nodes)."""

    name = "kick"

    @ti.func
    def give(self, p, dx):
        """Return m [kg], m t g and -t V0 tau/(m2 dx) [kg m/s], with the time t in which forces act."""
        momentum, affine = self.scheme.response.impulse(p, dx)
        return self.scheme.particles.mass[p], momentum, affine

    @ti.func
    def take(self, p, v, L, dx):
        """Accelerate particle p; sets no limits."""
        self.scheme.kicked[p] = Motion(v, L)
        self.scheme.change(p, v, L)
        return no_limits()

    @ti.func
    def take_alone(self, p, dx):
        """Accelerate particle p, which shares no node, freely; sets no limits."""
        C = self.scheme.particles.C[p]
        self.scheme.response.fly(p)
        self.scheme.kicked[p] = Motion(vec3(0.0), mat3(0.0))
        self.scheme.lose_affine(p, C, self.scheme.particles.C[p])
        return no_limits()


@ti.data_oriented
class WallContact(MotionExchange):
    """Walls: q <- q + gather(change of the nodes' velocity)."""

    name = "wall"

    @ti.func
    def take(self, p, v, L, dx):
        """Change particle p by what walls did to its nodes; sets no limits."""
        self.scheme.change(p, v, L)
        return no_limits()


@ti.data_oriented
class Projection(MotionExchange):
    """Deformation by the gradient of the projected motion Pi q, and the remainder r = q - Pi q."""

    name = "projection"

    @ti.func
    def take(self, p, v, L, dx):
        """Deform particle p by the gradient L at the middle of the step; returns its limits.

        The displacement gradient of the step, dt L (I - dt L/2)^-1, is exact in a linear flow.
        """
        q, dt = self.scheme.motion(p), self.scheme.clock.dt[None]
        self.scheme.remainder[p] = Motion(q.v - v, q.C - L)
        return self.scheme.response.deform(p, moved(L, -0.5 * dt), dx)

    @ti.func
    def take_alone(self, p, dx):
        """Leave particle p, which is its own projection, as it is; returns its limits."""
        self.scheme.remainder[p] = Motion(vec3(0.0), mat3(0.0))
        return self.scheme.response.rest(p, dx)


@ti.data_oriented
class Correction(MotionExchange):
    """Filter q <- q - kappa d, with d = r - Pi r = (1 - Pi)^2 q and kappa = dt times the rate, at most 1."""

    name = "correction"

    @ti.func
    def give(self, p, dx):
        """Return the mass and the remainder of particle p."""
        return self.scheme.scaled(p, self.scheme.remainder[p], dx)

    @ti.func
    def take(self, p, v, L, dx):
        """Filter the motion of particle p, and keep its energy as heat; sets no limits."""
        kappa = ti.min(1.0, self.scheme.rate[None] * self.scheme.clock.dt[None])
        r = self.scheme.remainder[p]
        d = Motion(r.v - v, r.C - L)
        self.scheme.change(p, -kappa * d.v, -kappa * d.C)
        lost = kappa * (product(r, r, dx) - 0.5 * kappa * product(d, d, dx))
        # work: forces act on the motion that is left, strain is that of the motion before
        share = self.scheme.clock.dt[None] / self.scheme.clock.kick[None]
        self.scheme.lose(p, lost + 0.5 * share * kappa * product(d, self.scheme.kicked[p], dx))
        return no_limits()


@ti.data_oriented
class Change:
    """What walls take from the velocity of nodes.

    Args:
        walls: boundary of space.
    """

    def __init__(self, walls: Boundary) -> None:
        self.walls = walls

    @ti.func
    def apply(self, x, velocity):
        """Return the change of the velocity [m/s] at x [m] by the walls."""
        return self.walls.apply(x, velocity) - velocity


@ti.data_oriented
class Drift:
    """Motion for half a step: x <- x + dt v/2, and the affine velocity with it.

    Args:
        scheme: whose particles move.
    """

    def __init__(self, scheme: Filtered) -> None:
        self.scheme, self.particles, self.clock = scheme, scheme.particles, scheme.clock

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        """A loop over particles."""
        return (self.move,)

    @ti.kernel
    def move(self):
        """Move all particles, unless the clock has paused."""
        half = 0.5 * self.clock.dt[None]
        for p in range(self.particles.number[None] * self.clock.running[None]):
            C = self.particles.C[p]
            after = affine_velocity(C, half, self.scheme.response.constitution.expansion(p), self.scheme.steepest[None])
            self.particles.C[p] = after
            self.scheme.lose_affine(p, C, after)
            self.scheme.response.move(p, half)
