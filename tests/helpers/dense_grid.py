"""The transfer on one grid without blocks, in plain NumPy: a twin of the engine (engine/physics.md, section 1).

It is evidence that blocks, copies and their sums make the sums of one grid, and not that the equations are right.
"""

from dataclasses import dataclass

import numpy as np

from tests.helpers.device import Array
from tests.helpers.oracle import RHO0
from tests.helpers.scenes import spline

STENCIL = np.stack(np.meshgrid(*[range(3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
INDEX = [[0, 5, 4], [5, 1, 3], [4, 3, 2]]
"""Components of a symmetric tensor among its six."""


@dataclass
class Motion:
    """Velocities [m/s] and their gradients [1/s] of particles, shapes [n, 3] and [n, 3, 3]."""

    v: Array
    C: Array

    def plus(self, other: "Motion", factor: float = 1.0) -> "Motion":
        """Return self + factor other."""
        return Motion(self.v + factor * other.v, self.C + factor * other.C)

    def square(self, dx: float) -> Array:
        """Return |v|^2 + dx^2/4 |C|^2 of every particle [m^2/s^2]."""
        return np.asarray((self.v**2).sum(axis=1) + 0.25 * dx**2 * (self.C**2).sum(axis=(1, 2)))


class DenseGrid:
    """All nodes that particles at x [m] of some mass [kg] reach, at a spacing dx [m]."""

    def __init__(self, x: Array, mass: Array, dx: float) -> None:
        nodes = np.floor(x / dx - 0.5).astype(int)[:, None, :] + STENCIL
        self.mass, self.dx, self.offset = mass, dx, nodes * dx - x[:, None, :]
        self.weight = spline(self.offset / dx).prod(axis=2)
        found = np.unique(nodes.reshape(-1, 3), axis=0, return_inverse=True)
        self.index = found[1].reshape(len(x), -1)
        self.node_mass = self._summed(self.weight * mass[:, None])
        users = np.bincount(self.index.ravel())
        self.alone = (users[self.index] == 1).all(axis=1)

    def project(self, q: Motion) -> Motion:
        """Return Pi q: the motion that particles gather from nodes to which they gave q."""
        given = q.v[:, None, :] + np.einsum("pij,pnj->pni", q.C, self.offset)
        momentum = self._summed((self.weight * self.mass[:, None])[..., None] * given)
        u = (momentum / self.node_mass[:, None])[self.index]
        v = np.einsum("pn,pni->pi", self.weight, u)
        return Motion(v, 4.0 / self.dx**2 * np.einsum("pn,pni,pnj->pij", self.weight, u, self.offset))

    def _summed(self, values: Array) -> Array:
        total = np.zeros((int(self.index.max()) + 1, *values.shape[2:]))
        np.add.at(total, self.index, values)
        return total


def forces(state: dict[str, Array], dx: float, dt: float) -> Motion:
    """Return what gravity and stress add to the motion of every particle before the grid spreads it."""
    return Motion(dt * state["acceleration"], -4.0 * dt / (RHO0 * dx**2) * state["tau"][:, INDEX])


def affine_velocity(C: Array, dt: float, j: Array, rate: float) -> Array:
    """sym(C (I + dt C)^-1) + skew(C), the part of S = sym(C) bounded.

    By |S| max(J, 1)^(1/3) where matter is dilated, and by |S| where it exceeds a rate.
    """
    unit, skew = np.eye(3), 0.5 * (C - C.transpose(0, 2, 1))
    S, moved = C - skew, C @ np.linalg.inv(unit + dt * C)
    J, dilated = 1.0 + j, (1.0 + j) * np.linalg.det(unit + dt * S)
    free = S @ np.linalg.inv(unit + dt * S)
    fast = np.linalg.norm(S, axis=(1, 2)) > rate
    dilation = np.maximum(dilated / np.maximum(J, 1.0), np.where(fast, 1.0, 1e-300))
    bound = np.linalg.norm(S, axis=(1, 2)) * dilation ** (-1.0 / 3.0)
    factor = np.minimum(1.0, bound / np.maximum(np.linalg.norm(free, axis=(1, 2)), 1e-300))
    excess = np.where((dilated > 1.0) | fast, 1.0 - factor, 0.0)[:, None, None] * free
    return np.asarray(0.5 * (moved + moved.transpose(0, 2, 1)) - excess + skew)
