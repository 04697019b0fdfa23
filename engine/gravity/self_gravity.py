"""Self-gravity of particles: what a direct sum and a tree have in common (engine/physics.md, section 7)."""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.constants import G_NEWTON
from engine.device.backend import Real, capacity, on_gpu, overwrite
from engine.gravity.net_force import NetEffect, without_net_effect

LANES = 8
"""Targets that one CPU thread serves at once: as many doubles as the widest registers hold."""

Vectors = NDArray[np.float64]
Places = NDArray[np.int64]


@ti.data_oriented
class SelfGravity(ABC):
    """Pull of every particle, taken as a homogeneous ball of one radius, on every other.

    `x`, `y`, `z`, `mu` (G times mass) and `radius` hold the particles in an order that suits the solver; `ax`, `ay`,
    `az` or `potential` receive its result. Units are the powers of two near the largest coordinate and mu, so that no
    power of a length is beyond single precision. All are one component a field: a row of targets is then one piece of
    memory, and their sums stay in registers.

    Args:
        particles: state of the particles.
        radius: radius of the ball [m]: the field is Newton's outside and linear inside.
        places: places for particles that the solver uses, a multiple of LANES.
    """

    def __init__(self, particles: Any, radius: float, places: int) -> None:
        self.particles, self.count = particles, particles.count
        self.acceleration = particles.require("acceleration")
        self.ball, self.radius = radius, ti.field(Real, ())
        shape = capacity(places)
        self.x, self.y, self.z, self.mu = (ti.field(Real, shape) for _ in range(4))
        self.ax, self.ay, self.az, self.potential = (ti.field(Real, shape) for _ in range(4))
        self.lanes = 1 if on_gpu() else LANES
        self.row = ti.types.vector(self.lanes, Real)

    @abstractmethod
    def arrange(self, x: Vectors) -> Places:
        """Which particle goes to each place; ~p is a place for no particle, at the position of particle p.

        Args:
            x: positions [m], shape [particle_count, 3].
        """

    @abstractmethod
    def solve(self, potential: bool) -> None:
        """Fill the potential, or else the acceleration, from positions and mu."""

    def accelerate(self, ahead: float) -> NetEffect:
        """Set every particle's acceleration to the pull at positions a time `ahead` [s] of now.

        Returns:
            What had to be taken out so that the pull has no net force and no net torque.
        """
        state = self.particles.read("x", "v", "mass")
        x, mass = state["x"] + ahead * state["v"], state["mass"]
        pull = self._evaluate(x, mass, self.ax, self.ay, self.az)
        acceleration, taken_out = without_net_effect(pull, x, mass)
        self.particles.write({"acceleration": acceleration})
        return taken_out

    def pull(self, ahead: float) -> Vectors:
        """Acceleration [m/s^2] at positions a time `ahead` [s] of now, shape [particle_count, 3]."""
        state = self.particles.read("x", "v", "mass")
        return self._evaluate(state["x"] + ahead * state["v"], state["mass"], self.ax, self.ay, self.az)

    def energy(self) -> float:
        """Gravitational energy [J] of the particles where they are."""
        state = self.particles.read("x", "mass")
        potential = self._evaluate(state["x"], state["mass"], self.potential)
        return 0.5 * float(np.sum(state["mass"] * potential[:, 0]))

    def _evaluate(self, x: Vectors, mass: Vectors, *wanted: ti.Field) -> Vectors:
        """The wanted results of a solution in SI units, in the order of the particles."""
        places = self.arrange(x)
        taken = places >= 0
        particle = np.where(taken, places, ~places)
        length, mu = _power_of_two(np.abs(x).max()), _power_of_two(G_NEWTON * mass.max())
        sources = (*(x[particle] / length).T, np.where(taken, G_NEWTON * mass[particle] / mu, 0.0))
        self.radius[None] = self.ball / length
        for field, values in zip((self.x, self.y, self.z, self.mu), sources, strict=True):
            overwrite(field, values)
        self.solve(potential=self.potential in wanted)
        place_of = np.empty(self.count, dtype=np.int64)
        place_of[particle[taken]] = np.flatnonzero(taken)
        unit = mu / length if self.potential in wanted else mu / length**2
        return unit * np.stack([field.to_numpy()[place_of] for field in wanted], axis=1, dtype=np.float64)

    @ti.func
    def at(self, p):
        """Acceleration of particle p [m/s^2], held since it was last set."""
        return self.acceleration[p]

    @ti.func
    def load(self, values: ti.template(), t):
        """The values of the row of targets that begins at t."""
        return self.row([values[t + i] for i in range(self.lanes)])

    @ti.func
    def store(self, values: ti.template(), t, row):
        """Set the values of the row of targets that begins at t."""
        for i in ti.static(range(self.lanes)):
            values[t + i] = row[i]

    @ti.func
    def clear(self, t, potential: ti.template()):
        """Forget the sums of a row of targets; their own balls, which will be added, do not count."""
        if ti.static(potential):
            self.store(self.potential, t, 1.5 / self.radius[None] * self.load(self.mu, t))
        else:
            for field in ti.static((self.ax, self.ay, self.az)):
                self.store(field, t, self.row(0.0))

    @ti.func
    def add_balls(self, first, last, t, potential: ti.template()):
        """Add the pull or the potential of the particles in some places to a row of targets."""
        if ti.static(potential):
            self.add_ball_potential(first, last, t)
        else:
            self.add_ball_pull(first, last, t)

    @ti.func
    def add_ball_pull(self, first, last, t):
        """Newton's pull outside, linear inside."""
        X, Y, Z = self.load(self.x, t), self.load(self.y, t), self.load(self.z, t)
        ax, ay, az = self.load(self.ax, t), self.load(self.ay, t), self.load(self.az, t)
        ball = self.radius[None] ** 2
        for q in range(first, last):
            dx, dy, dz = self.x[q] - X, self.y[q] - Y, self.z[q] - Z
            square = ti.max(dx * dx + dy * dy + dz * dz, ball)
            strength = self.mu[q] / (square * ti.sqrt(square))
            ax += strength * dx
            ay += strength * dy
            az += strength * dz
        self.store(self.ax, t, ax)
        self.store(self.ay, t, ay)
        self.store(self.az, t, az)

    @ti.func
    def add_ball_potential(self, first, last, t):
        """Inside, 1/r becomes (3 - r^2/R^2) / 2R; outside, the bracket below is one."""
        X, Y, Z = self.load(self.x, t), self.load(self.y, t), self.load(self.z, t)
        potential = self.load(self.potential, t)
        ball = self.radius[None] ** 2
        for q in range(first, last):
            dx, dy, dz = self.x[q] - X, self.y[q] - Y, self.z[q] - Z
            square = dx * dx + dy * dy + dz * dz
            inverse = 1.0 / ti.sqrt(ti.max(square, ball))
            potential -= self.mu[q] * inverse * (1.5 - 0.5 * ti.min(square * inverse * inverse, 1.0))
        self.store(self.potential, t, potential)


def _power_of_two(size: float) -> float:
    """The unit near a size that changes no digit: the least power of two above it."""
    return float(np.ldexp(1.0, np.frexp(size)[1]))
