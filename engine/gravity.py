"""Self-gravity of particles: what a direct sum and a tree have in common (engine/physics.md, section 7)."""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.backend import Real, capacity, overwrite
from engine.orbit import G

Vectors = NDArray[np.float64]
Places = NDArray[np.int64]


@ti.data_oriented
class SelfGravity(ABC):
    """Pull of every particle, taken as a homogeneous ball of one radius, on every other.

    `x`, `y`, `z`, `mu` (G times mass) hold the particles in an order that suits the solver; `ax`, `ay`, `az` and
    `potential` receive its result, one component a field so that loops over targets run through memory in step.

    Args:
        particles: state of the particles.
        radius: radius of the ball [m]: the field is Newton's outside and linear inside.
        places: places for particles that the solver uses; at least their number.
    """

    def __init__(self, particles: Any, radius: float, places: int) -> None:
        self.particles, self.count = particles, particles.count
        self.acceleration = particles.hold("acceleration")
        self.radius = ti.field(Real, ())
        self.radius[None] = radius
        shape = capacity(places)
        self.x, self.y, self.z, self.mu = (ti.field(Real, shape) for _ in range(4))
        self.ax, self.ay, self.az, self.potential = (ti.field(Real, shape) for _ in range(4))

    @abstractmethod
    def arrange(self, x: Vectors) -> Places:
        """Which particle goes to each place, or -1 for none.

        Args:
            x: positions [m], shape [particle_count, 3].
        """

    @abstractmethod
    def solve(self) -> None:
        """Fill acceleration and potential from positions and mu."""

    def accelerate(self, ahead: float) -> None:
        """Set every particle's acceleration to the pull at positions a time `ahead` [s] of now."""
        state = self.particles.read("x", "v", "mass")
        x = state["x"] + ahead * state["v"]
        pull = self._evaluate(x, state["mass"], self.ax, self.ay, self.az)
        self.particles.write({"acceleration": without_net_effect(pull, x, state["mass"])})

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
        """The wanted results of a solution, in the order of the particles."""
        particle = self.arrange(x)
        taken = particle >= 0
        sources = (*x[np.maximum(particle, 0)].T, np.where(taken, G * mass[particle], 0.0))
        for field, values in zip((self.x, self.y, self.z, self.mu), sources, strict=True):
            overwrite(field, values)
        self.solve()
        result = np.empty((self.count, len(wanted)))
        for column, field in enumerate(wanted):
            result[particle[taken], column] = field.to_numpy()[: len(particle)][taken]
        return result

    @ti.func
    def at(self, p):
        """Acceleration of particle p [m/s^2], held since it was last set."""
        return self.acceleration[p]

    @ti.func
    def clear(self, first, last):
        """Forget the sums of a range of targets, less the share of each particle's own ball that will be added."""
        for p in range(first, last):
            self.ax[p], self.ay[p], self.az[p] = 0.0, 0.0, 0.0
            self.potential[p] = 1.5 * self.mu[p] / self.radius[None]

    @ti.func
    def add_ball(self, q, first, last):
        """Add the pull of particle q to a range of targets."""
        x, y, z, mu = self.x[q], self.y[q], self.z[q], self.mu[q]
        ball = self.radius[None] ** 2
        for p in range(first, last):
            dx, dy, dz = x - self.x[p], y - self.y[p], z - self.z[p]
            square = dx * dx + dy * dy + dz * dz
            inverse = 1.0 / ti.sqrt(ti.max(square, ball))
            strength = mu * inverse * inverse * inverse
            self.ax[p] = self.ax[p] + strength * dx
            self.ay[p] = self.ay[p] + strength * dy
            self.az[p] = self.az[p] + strength * dz
            # inside the ball 1/r becomes (3 - r^2/R^2) / 2R; outside the bracket is one
            self.potential[p] = self.potential[p] - mu * inverse * (1.5 - 0.5 * ti.min(square * inverse * inverse, 1.0))


def without_net_effect(pull: Vectors, x: Vectors, mass: Vectors) -> Vectors:
    """Accelerations without net force and net torque, which no forces between pairs have.

    Of all corrections that achieve this, the rigid motion taken out is the smallest in the mass-weighted mean square.

    Args:
        pull: accelerations [m/s^2], shape [particle_count, 3].
        x: positions [m], shape [particle_count, 3].
        mass: masses [kg], shape [particle_count].
    """
    r = x - np.average(x, axis=0, weights=mass)
    rest = pull - np.average(pull, axis=0, weights=mass)
    torque = np.sum(mass[:, None] * np.cross(r, rest), axis=0)
    moments = np.einsum("p,pi,pj->ij", mass, r, r)
    inertia = np.trace(moments) * np.eye(3) - moments
    return np.asarray(rest - np.cross(np.linalg.pinv(inertia, hermitian=True) @ torque, r))
