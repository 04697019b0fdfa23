"""Contracts of the grid: a transfer scheme, and what bounds space."""

from typing import Protocol


class Scheme(Protocol):
    """What a particle gives to the nodes of the grid and what it takes from them (engine/physics.md, section 1).

    All methods are device functions. The stencil adds over particles and averages over nodes what a scheme names.
    """

    def momentum(self, p, dx):
        """Return mass, momentum and affine momentum of particle p; called once a step, from particles to the grid.

        The node at distance r, in cells, and of weight w receives w (momentum + affine r) and w mass.

        Args:
            p: index of the particle.
            dx: grid spacing [m].
        """

    def advance(self, p, v, L, dx):
        """Move and deform particle p over the step and return its limits of the next; called last in a step.

        Args:
            p: index of the particle.
            v: mean velocity of its nodes [m/s].
            L: velocity gradient at the particle [1/s].
            dx: grid spacing [m].
        """

    def advance_ballistic(self, p, dx):
        """Do the same for a particle that shares no node with another."""


class Boundary(Protocol):
    """What bounds space, acting on nodes and on ballistic particles (engine/physics.md, section 11)."""

    def apply(self, x, velocity):
        """Return the velocity [m/s] that is left at x [m] of a velocity there."""
