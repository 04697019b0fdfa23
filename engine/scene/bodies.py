"""Bodies a scene can have: a sphere or a box of equal particles. SI units throughout."""

from abc import abstractmethod
from typing import Annotated, Self

from pydantic import Field

from engine.scene.fields import Frozen, Number, Positive, Vector, Whole, key
from engine.scene.material import Material, named

PositiveVector = tuple[Positive, Positive, Positive]
MOST_PARTICLES = 2**30
"""Particles that 32-bit indices can count, in fields whose sizes are powers of two."""

Count = Annotated[Whole, Field(ge=1, le=MOST_PARTICLES)]
Damage = Annotated[Number, Field(ge=0.0, le=1.0)]


class Body(Frozen):
    """What bodies of every shape have in common."""

    name: Annotated[str, key("name of the body")] = "body"
    position: Annotated[Vector, key("position of the centre", "m")] = (0.0, 0.0, 0.0)
    velocity: Annotated[Vector, key("velocity of the centre", "m s-1")] = (0.0, 0.0, 0.0)
    spin: Annotated[Vector, key("angular velocity about the centre", "rad s-1")] = (0.0, 0.0, 0.0)
    material: Annotated[Material, key("material: a name, or constants")] = named("basalt")
    damage: Annotated[Damage, key("damage at the start", "1")] = 0.0

    @property
    @abstractmethod
    def volume(self) -> float:
        """Volume [m^3] at the reference density."""

    @property
    @abstractmethod
    def count(self) -> int:
        """Number of particles."""

    @property
    @abstractmethod
    def reach(self) -> float:
        """Distance [m] from the centre to the farthest point."""

    @property
    @abstractmethod
    def spin_momentum(self) -> Vector:
        """Angular momentum [kg m^2/s] of the spin."""

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.material.rho0 * self.volume

    @property
    def spacing(self) -> float:
        """Particle spacing h = (m/rho0)^(1/3) [m]."""
        return float((self.volume / self.count) ** (1.0 / 3.0))


class Sphere(Body):
    """A homogeneous sphere of `particles` equal particles."""

    radius: Annotated[Positive, key("radius", "m")]
    particles: Annotated[Count, key("number of particles", "1")]
    hydrostatic: Annotated[
        bool | None, key("whether it starts under the pressure of its own gravity; by default where there is gravity")
    ] = None

    def balanced(self, gravity: bool) -> Self:
        """The same body, hydrostatic under its own gravity unless it says otherwise."""
        return self if self.hydrostatic is not None else self.model_copy(update={"hydrostatic": gravity})

    @property
    def volume(self) -> float:
        """Volume [m^3] at the reference density."""
        return 4.0 / 3.0 * 3.141592653589793 * self.radius**3

    @property
    def count(self) -> int:
        """Number of particles."""
        return self.particles

    @property
    def reach(self) -> float:
        """The radius [m]."""
        return self.radius

    @property
    def spin_momentum(self) -> Vector:
        """Angular momentum [kg m^2/s] of the spin."""
        x, y, z = (0.4 * self.mass * self.radius**2 * component for component in self.spin)
        return x, y, z


class Box(Body):
    """A homogeneous cuboid around `position`: a rectangular lattice of `lattice` particles per edge."""

    size: Annotated[PositiveVector, key("length of the edges", "m")]
    lattice: Annotated[tuple[Count, Count, Count], key("particles along each edge", "1")]

    @property
    def volume(self) -> float:
        """Volume [m^3] at the reference density."""
        return self.size[0] * self.size[1] * self.size[2]

    @property
    def count(self) -> int:
        """Number of particles."""
        return self.lattice[0] * self.lattice[1] * self.lattice[2]

    @property
    def reach(self) -> float:
        """Half the diagonal [m]."""
        return 0.5 * float(sum(edge**2 for edge in self.size) ** 0.5)

    @property
    def spin_momentum(self) -> Vector:
        """Angular momentum [kg m^2/s] of the spin."""
        square = sum(edge**2 for edge in self.size)
        moments = (self.mass / 12.0 * (square - edge**2) for edge in self.size)
        x, y, z = (moment * component for moment, component in zip(moments, self.spin, strict=True))
        return x, y, z
