"""Self-gravity of particles: base class of the direct sum and of the tree (engine/physics.md, section 7)."""

from abc import ABC, abstractmethod

import numpy as np
import taichi as ti

from engine.arrays import Indices, Scalars, Vectors
from engine.constants import G_NEWTON
from engine.device.backend import Real, on_gpu
from engine.device.fields import allocate, capacity, overwrite
from engine.gravity.net_force import NetForce, remove_net_force_and_torque
from engine.state.particles import Particles

LANES = 8
"""Targets that one CPU thread serves at once: as many doubles as the widest registers hold."""


@ti.data_oriented
class SelfGravity(ABC):
    """Gravity of every particle, a homogeneous ball of one radius, on every other.

    A solver works in scaled units, the powers of two above the largest coordinate and the largest `gm`: so no power of
    a length leaves the range of single precision. Each component has a field of its own: the values of a row of targets
    are then contiguous, and their sums stay in registers.

    In device functions t is the slot at which a row of targets begins; `potential`, known when they are compiled, says
    whether potentials are summed, else accelerations.

    Args:
        particles: state of the particles.
        radius: radius of the ball [m]; the field is Newton's outside and linear inside.
        slots: number of sources that the solver stores, particles and padding; a multiple of LANES.

    Attributes:
        x, y, z: positions in the solver's order, shape [slots].
        gm: G_NEWTON times mass in the solver's order, 0 for padding, shape [slots].
        radius: radius of the ball, in the unit of the positions.
        ax, ay, az: accelerations that the solver returns, shape [slots].
        potential: potential that the solver returns, shape [slots].
    """

    def __init__(self, particles: Particles, radius: float, slots: int) -> None:
        self.particles, self.count = particles, particles.count
        self.acceleration = particles.require("acceleration")
        self.ball, self.radius = radius, allocate(Real)
        shape = capacity(slots)
        self.x, self.y, self.z, self.gm = (allocate(Real, shape) for _ in range(4))
        self.ax, self.ay, self.az, self.potential = (allocate(Real, shape) for _ in range(4))
        self.lanes = 1 if on_gpu() else LANES
        self.row = ti.types.vector(self.lanes, Real)

    @abstractmethod
    def arrange(self, x: Vectors) -> Indices:
        """Return the particle in each slot; ~p marks padding, without mass, at the position of particle p.

        Args:
            x: positions [m], shape [particle_count, 3].

        Returns:
            Shape [slots].
        """

    @abstractmethod
    def solve(self, potential: bool) -> None:
        """Compute potential or acceleration of all slots from `x`, `y`, `z` and `gm`, in the solver's units.

        Args:
            potential: whether the potential is computed, else the acceleration.
        """

    def accelerate(self, ahead: float) -> NetForce:
        """Set the acceleration to that at future positions, without net force and net torque.

        Args:
            ahead: time [s] for which particles are taken to move on straight.

        Returns:
            The net force and torque that were removed.
        """
        state = self.particles.read("x", "v", "mass")
        x, mass = state["x"] + ahead * state["v"], state["mass"]
        acceleration, removed = remove_net_force_and_torque(self.accelerations(x, mass), x, mass)
        self.particles.write({"acceleration": acceleration})
        return removed

    def accelerations(self, x: Vectors, mass: Scalars) -> Vectors:
        """Return the solver's accelerations [m/s^2], shape [particle_count, 3].

        Args:
            x: positions [m], shape [particle_count, 3].
            mass: masses [kg], shape [particle_count].
        """
        return self._evaluate(x, mass, self.ax, self.ay, self.az)

    def potentials(self, x: Vectors, mass: Scalars) -> Scalars:
        """Return the potential [J/kg] of all others at each particle, shape [particle_count]; arguments as above."""
        return self._evaluate(x, mass, self.potential)[:, 0]

    def energy(self, x: Vectors, mass: Scalars) -> float:
        """Return half the sum of mass times potential [J]; arguments as above."""
        return 0.5 * float(np.sum(mass * self.potentials(x, mass)))

    def _evaluate(self, x: Vectors, mass: Scalars, *wanted: ti.Field) -> Vectors:
        """Wanted results of a solution in SI units, shape [particle_count, number of results]."""
        slots = self.arrange(x)
        taken = slots >= 0
        particle = np.where(taken, slots, ~slots)
        length, gm = _power_of_two(np.abs(x).max()), _power_of_two(G_NEWTON * mass.max())
        sources = (*(x[particle] / length).T, np.where(taken, G_NEWTON * mass[particle] / gm, 0.0))
        self.radius[None] = self.ball / length
        for field, values in zip((self.x, self.y, self.z, self.gm), sources, strict=True):
            overwrite(field, values)
        self.solve(potential=self.potential in wanted)
        slot_of = np.empty(self.count, dtype=np.int64)
        slot_of[particle[taken]] = np.flatnonzero(taken)
        unit = gm / length if self.potential in wanted else gm / length**2
        return unit * np.stack([field.to_numpy()[slot_of] for field in wanted], axis=1, dtype=np.float64)

    @ti.func
    def at(self, p):
        """Return the acceleration of particle p of the last evaluation."""
        return self.acceleration[p]

    @ti.func
    def load(self, values: ti.template(), t):
        """Return the values of the row of targets that begins at slot t."""
        return self.row([values[t + i] for i in range(self.lanes)])

    @ti.func
    def store(self, values: ti.template(), t, row):
        """Set the values of the row of targets that begins at slot t."""
        for i in ti.static(range(self.lanes)):
            values[t + i] = row[i]

    @ti.func
    def reset(self, t, potential: ti.template()):
        """Reset the sums of a row of targets; start the potential at minus the self-term that `add_balls` will add."""
        if ti.static(potential):
            self.store(self.potential, t, 1.5 / self.radius[None] * self.load(self.gm, t))
        else:
            for field in ti.static((self.ax, self.ay, self.az)):
                self.store(field, t, self.row(0.0))

    @ti.func
    def add_balls(self, first, last, t, potential: ti.template()):
        """Add the acceleration or the potential of the particles in slots `first` to `last` to a row of targets."""
        if ti.static(potential):
            self.add_ball_potential(first, last, t)
        else:
            self.add_ball_pull(first, last, t)

    @ti.func
    def add_ball_pull(self, first, last, t):
        """Add gm d / max(r, R)^3: Newton's acceleration outside the ball, linear inside."""
        X, Y, Z = self.load(self.x, t), self.load(self.y, t), self.load(self.z, t)
        ax, ay, az = self.load(self.ax, t), self.load(self.ay, t), self.load(self.az, t)
        ball = self.radius[None] ** 2
        for q in range(first, last):
            dx, dy, dz = self.x[q] - X, self.y[q] - Y, self.z[q] - Z
            square = ti.max(dx * dx + dy * dy + dz * dz, ball)
            strength = self.gm[q] / (square * ti.sqrt(square))
            ax += strength * dx
            ay += strength * dy
            az += strength * dz
        self.store(self.ax, t, ax)
        self.store(self.ay, t, ay)
        self.store(self.az, t, az)

    @ti.func
    def add_ball_potential(self, first, last, t):
        """Add -gm / r outside the ball, -gm (3 - r^2/R^2) / 2R inside; outside, the bracket below is one."""
        X, Y, Z = self.load(self.x, t), self.load(self.y, t), self.load(self.z, t)
        potential = self.load(self.potential, t)
        ball = self.radius[None] ** 2
        for q in range(first, last):
            dx, dy, dz = self.x[q] - X, self.y[q] - Y, self.z[q] - Z
            square = dx * dx + dy * dy + dz * dz
            inverse = 1.0 / ti.sqrt(ti.max(square, ball))
            potential -= self.gm[q] * inverse * (1.5 - 0.5 * ti.min(square * inverse * inverse, 1.0))
        self.store(self.potential, t, potential)


def _power_of_two(size: float) -> float:
    """Least power of two above a size: as a unit it changes no digit."""
    return float(np.ldexp(1.0, np.frexp(size)[1]))
