"""Contracts of the grid: a transfer scheme, and what bounds space."""

from typing import Protocol


class Scheme(Protocol):
    """What a particle gives to the nodes of the grid and what it takes from them (engine/physics.md, section 1).

    Device functions but for `inertia`. Nodes keep one velocity, that after the grid update.
    """

    def inertia(self, dx: float) -> float:
        """Return the moment of inertia per mass [m^2] of the affine motion of a particle; zero where it has none.

        Called on the host, for the conserved quantities.

        Args:
            dx: grid spacing [m].
        """

    def momentum(self, p, dx):
        """Return mass [kg], momentum [kg m/s] and affine momentum [kg m/s], shape [3, 3]; called once a step, in p2g.

        The node at distance r, in cells, and of weight w receives w (momentum + affine r) and w mass.

        Args:
            p: index of the particle.
            dx: grid spacing [m].
        """

    def advance(self, p, v, L, dx):
        """Move and deform particle p over the step; called once a step, in g2p.

        Returns the `Limits` of the next time step (engine/mpm/time_step.py).

        Args:
            p: index of the particle.
            v: mean velocity of its nodes [m/s].
            L: velocity gradient at the particle [1/s].
            dx: grid spacing [m].
        """

    def advance_ballistic(self, p, dx):
        """Move particle p, which shares no node with another, and return its `Limits`; arguments as `advance`."""


class Boundary(Protocol):
    """What bounds space, acting on nodes and on ballistic particles (engine/physics.md, section 11)."""

    def apply(self, x, velocity):
        """Return the velocity [m/s] that is left at x [m] of a velocity there."""
