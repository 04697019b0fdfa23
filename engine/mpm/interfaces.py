"""Contracts of the grid: a transfer scheme, its exchanges with the grid, and what bounds space."""

from collections.abc import Callable
from typing import Protocol

from engine.device.launches import Kernel


class Boundary(Protocol):
    """What bounds space, acting on nodes and on ballistic particles (engine/physics.md, section 11)."""

    def apply(self, x, velocity):
        """Return the velocity [m/s] that is left at x [m] of a velocity there."""


class ContactLaw(Protocol):
    """Where bodies touch (engine/physics.md, section 1).

    Attributes:
        separates: whether bodies have motion of their own at a node; if not, the rest is not compiled.
    """

    separates: bool

    def filled(self, mass, body):
        """Return what a mass [kg] of a body at its reference density fills of a node [-]."""

    def touches(self, own, all_bodies):
        """Return whether a body that fills `own` of a node [-] touches the others, of all that is filled."""


class Exchange(Protocol):
    """What a particle gives to its nodes and takes from them in one pass over the grid; device functions.

    Attributes:
        name: of the pass.
        nodes: what acts on the mean of what was given to a node.
    """

    name: str
    nodes: Boundary

    def give(self, p, dx):
        """Return mass [kg], momentum [kg m/s] and affine momentum [kg m/s], shape [3, 3]; called once a pass.

        The node at distance r, in cells, and of weight w receives w (momentum + affine r) and w mass.

        Args:
            p: index of the particle.
            dx: grid spacing [m].
        """

    def take(self, p, v, L, dx):
        """Change particle p by what its nodes have received; called once a pass.

        Returns the `Limits` of the next time step (engine/mpm/time_step.py); zeros where the pass sets none.

        Args:
            p: index of the particle.
            v: mean over its nodes [m/s].
            L: gradient at the particle [1/s].
            dx: grid spacing [m].
        """

    def take_alone(self, p, dx):
        """Change particle p, which shares no node with another of its body or of one that touches; as `take`."""


class Stage(Protocol):
    """A part of a time step for all particles."""

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        """What it does, in order; they do nothing when the clock has paused."""


class Scheme(Protocol):
    """A transfer between particles and grid (engine/physics.md, section 1)."""

    def stages(self, over_grid: Callable[[Exchange], Stage]) -> tuple[Stage, ...]:
        """Return the parts of a time step, in order.

        Args:
            over_grid: makes an exchange a pass over the grid.
        """

    def inertia(self, dx: float) -> float:
        """Return the moment of inertia per mass [m^2] of the affine motion of a particle; zero where it has none.

        Args:
            dx: grid spacing [m].
        """
