"""Self-gravity of particles: base class of the direct sum and of the tree (engine/physics.md, section 7)."""

from abc import ABC, abstractmethod

import numpy as np
import taichi as ti

from engine.arrays import Scalars, Vector, Vectors
from engine.constants import G_NEWTON
from engine.device.backend import Real, on_gpu, place3
from engine.device.fields import allocate, capacity, overwrite
from engine.device.fixed_order_sum import FixedOrderSum
from engine.gravity.net_force import NetForce, RigidCorrection
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
        position, mass: of every particle when gravity is computed [m, kg].
        pull: acceleration [m/s^2] that the solver finds for every particle; potential [J/kg] as first component.
        particle_of: particle in every slot; ~p marks padding, without mass, at the position of particle p.
        x, y, z: positions in the solver's order, shape [slots].
        gm: G_NEWTON times mass in the solver's order, 0 for padding, shape [slots].
        radius: radius of the ball, in the unit of the positions.
        ax, ay, az: accelerations that the solver returns, shape [slots].
        potential: potential that the solver returns, shape [slots].
    """

    def __init__(self, particles: Particles, radius: float, slots: int) -> None:
        self.particles, self.count, self.slots = particles, particles.count, slots
        self.acceleration = particles.require("acceleration")
        self.position, self.pull = (allocate(place3, capacity(self.count)) for _ in range(2))
        self.mass, self.particle_of = allocate(ti.f64, capacity(self.count)), allocate(ti.i32, capacity(slots))
        self.extent, self.largest_mass = allocate(ti.f64), allocate(ti.f64)
        self.potential_sum = FixedOrderSum(self.mass_times_potential, 1, self.count)
        self.rigid = RigidCorrection(self.position, self.mass, self.pull, self.acceleration, self.count)
        self.ball, self.radius = radius, allocate(Real)
        shape = capacity(slots)
        self.x, self.y, self.z, self.gm = (allocate(Real, shape) for _ in range(4))
        self.ax, self.ay, self.az, self.potential = (allocate(Real, shape) for _ in range(4))
        self.lanes = 1 if on_gpu() else LANES
        self.row = ti.types.vector(self.lanes, Real)

    @abstractmethod
    def arrange(self) -> None:
        """Set `particle_of` every slot: index of a particle, or ~p for padding, without mass, at that of particle p."""

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
        self.take_particles(ahead, self.count)
        self._evaluate(potential=False)
        return self.rigid.apply()

    def accelerations(self, x: Vectors, mass: Scalars) -> Vectors:
        """Return the solver's accelerations [m/s^2], shape [particle_count, 3].

        Args:
            x: positions [m], shape [particle_count, 3].
            mass: masses [kg], shape [particle_count].
        """
        self._place(x, mass)
        self._evaluate(potential=False)
        return np.asarray(self.pull.to_numpy()[: self.count])

    def potentials(self, x: Vectors, mass: Scalars) -> Scalars:
        """Return the potential [J/kg] of all others at each particle, shape [particle_count]; arguments as above."""
        self._place(x, mass)
        self._evaluate(potential=True)
        return np.asarray(self.pull.to_numpy()[: self.count, 0])

    def energy(self, moment: Vector) -> float:
        """Return half the sum of mass times potential [J], which the sum of mass times position does not tell."""
        self.take_particles(0.0, self.count)
        self._evaluate(potential=True)
        return 0.5 * float(self.potential_sum.over(self.count)[0])

    @ti.func
    def mass_times_potential(self, p):
        """Return mass times potential of particle p [J]."""
        return ti.Vector([self.mass[p] * self.pull[p][0]])

    def _place(self, x: Vectors, mass: Scalars) -> None:
        overwrite(self.position, x)
        overwrite(self.mass, mass)

    def _evaluate(self, potential: bool) -> None:
        """Set the pull to a solution in SI units for the present positions and masses."""
        self.find_extent(self.count)
        length = _power_of_two(self.extent[None])
        gm = _power_of_two(G_NEWTON * self.largest_mass[None])
        self.arrange()
        self.radius[None] = self.ball / length
        self.fill_slots(self.slots, length, gm / G_NEWTON)
        self.solve(potential)
        unit = gm / length if potential else gm / length**2
        self.take_results(self.slots, unit, potential)

    @ti.kernel
    def take_particles(self, ahead: ti.f64, count: ti.i32):
        """Take the positions of the particles some time [s] ahead, and their masses."""
        for p in range(count):
            self.position[p] = self.particles.x[p] + ahead * ti.cast(self.particles.v[p], ti.f64)
            self.mass[p] = ti.cast(self.particles.mass[p], ti.f64)

    @ti.kernel
    def find_extent(self, count: ti.i32):
        """Find the largest coordinate and the largest mass."""
        self.extent[None], self.largest_mass[None] = 0.0, 0.0
        for p in range(count):
            ti.atomic_max(self.extent[None], ti.abs(self.position[p]).max())
            ti.atomic_max(self.largest_mass[None], self.mass[p])

    @ti.kernel
    def fill_slots(self, slots: ti.i32, length: ti.f64, mass: ti.f64):
        """Set positions and masses of all slots, in units of a length [m] and a mass [kg]."""
        for s in range(slots):
            value = self.particle_of[s]
            p = ti.max(value, ~value)
            x = ti.cast(self.position[p] / length, Real)
            self.x[s], self.y[s], self.z[s] = x[0], x[1], x[2]
            self.gm[s] = 0.0
            if value >= 0:
                self.gm[s] = ti.cast(self.mass[p] / mass, Real)

    @ti.kernel
    def take_results(self, slots: ti.i32, unit: ti.f64, potential: ti.template()):
        """Set the pull of every particle to what its slot has, in units of `unit`; a potential as first component."""
        for s in range(slots):
            p = self.particle_of[s]
            if p >= 0:
                if ti.static(potential):
                    self.pull[p] = unit * place3(self.potential[s], 0.0, 0.0)
                else:
                    self.pull[p] = unit * place3(self.ax[s], self.ay[s], self.az[s])

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
