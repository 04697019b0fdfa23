"""A scene: the bodies, the parts of physics they obey, and how finely to resolve them. SI units throughout."""

from pathlib import Path
from typing import Annotated, Self

from pydantic import Field, model_validator

from engine.errors import SceneError
from engine.materials import Fracture, Material
from engine.validation import Finite, Frozen, NonNegative, Positive, Vector, read_table, validate

Fraction = Annotated[float, Field(gt=0.0, le=1.0)]


class Body(Frozen):
    """A homogeneous sphere of `particles` equal particles."""

    name: str = "body"
    radius: Positive
    particles: Annotated[int, Field(ge=1)]
    position: Vector = (0.0, 0.0, 0.0)
    velocity: Vector = (0.0, 0.0, 0.0)
    spin: Vector = (0.0, 0.0, 0.0)
    material: Material = Material()
    damage: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0
    hydrostatic: bool = True

    @property
    def volume(self) -> float:
        """Volume [m^3] at the reference density."""
        return 4.0 / 3.0 * 3.141592653589793 * self.radius**3

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.material.rho0 * self.volume

    @property
    def spacing(self) -> float:
        """Particle spacing h = (m/rho0)^(1/3) [m]."""
        return float((self.volume / self.particles) ** (1.0 / 3.0))


class Gravity(Frozen):
    """Self-gravity of all particles.

    softening: radius of the ball that stands for one particle, in units of the largest spacing h.
    interval: time [s] for which one evaluation, made at positions half of it ahead, is held.
    """

    softening: Positive = 1.0
    interval: Positive = 10.0


class Viscosity(Frozen):
    """Explicit viscous stress.

    shear: kinematic shear viscosity nu [m^2/s].
    bulk: kinematic bulk viscosity zeta [m^2/s].
    shock_linear, shock_quadratic: von Neumann-Richtmyer coefficients [-], in compression only.
    """

    shear: NonNegative = 0.0
    bulk: NonNegative = 0.0
    shock_linear: NonNegative = 0.0
    shock_quadratic: NonNegative = 0.0


class Physics(Frozen):
    """The parts of physics a scene uses; `null` leaves a part out, and it then costs nothing.

    Pressure is always Tillotson's. `shear` adds the Hencky deviatoric stress, `strength` its radial return.
    """

    shear: bool = True
    strength: bool = True
    fracture: Fracture | None = Fracture()
    gravity: Gravity | None = Gravity()
    viscosity: Viscosity | None = None

    @model_validator(mode="after")
    def _parts_fit_together(self) -> Self:
        if self.strength and not self.shear:
            raise ValueError("'strength' limits shear stress: it needs shear = true")
        if self.fracture and not self.strength:
            raise ValueError("'fracture' weakens strength: it needs strength = true")
        return self


class Numerics(Frozen):
    """Resolution in space and time.

    particles_per_cell: fixes the grid, dx = h * particles_per_cell^(1/3).
    cfl: time step in units of dx / (wave speed + particle speed).
    """

    particles_per_cell: Positive = 4.0
    cfl: Fraction = 0.5


class Output(Frozen):
    """What is written while the scene runs.

    history_interval: simulated time [s] between rows of the conserved quantities.
    snapshot_interval: simulated time [s] between particle snapshots; `null` writes none.
    """

    history_interval: Positive = 100.0
    snapshot_interval: Positive | None = 1000.0


class Scene(Frozen):
    """Everything a run depends on; the same scene gives the same results."""

    bodies: Annotated[tuple[Body, ...], Field(min_length=1)]
    start_time: Finite = 0.0
    end_time: Finite
    seed: Annotated[int, Field(ge=0)] = 1
    physics: Physics = Physics()
    numerics: Numerics = Numerics()
    output: Output = Output()

    @model_validator(mode="after")
    def _ends_after_start(self) -> Self:
        if self.end_time <= self.start_time:
            raise ValueError(f"end_time {self.end_time} s is not after start_time {self.start_time} s")
        return self

    @property
    def particles(self) -> int:
        """Number of particles in all bodies."""
        return sum(body.particles for body in self.bodies)

    @property
    def spacing(self) -> float:
        """Largest particle spacing h [m] of all bodies."""
        return max(body.spacing for body in self.bodies)

    @property
    def dx(self) -> float:
        """Grid spacing [m]."""
        return self.spacing * float(self.numerics.particles_per_cell ** (1.0 / 3.0))


def read_scene(path: Path) -> Scene:
    """The scene in a TOML or JSON file.

    Raises:
        SceneError: the file cannot be read or its content is not a scene.
    """
    return validate(Scene, read_table(path), str(path))


def scene_in(directory: Path) -> Scene:
    """The scene of a job directory, `scene.json` or `scene.toml`.

    Raises:
        SceneError: neither file is there, or it is not a scene.
    """
    for name in ("scene.json", "scene.toml"):
        if (directory / name).is_file():
            return read_scene(directory / name)
    raise SceneError(f"{directory}: holds no scene.json or scene.toml; write the scene to run there first")
