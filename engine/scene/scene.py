"""A scene: the bodies, the parts of physics they obey, and how finely to resolve them. SI units throughout."""

from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, ValidationInfo, field_validator, model_validator

from engine.constants import BLOCK_EDGE
from engine.device.options import Precision
from engine.errors import SceneError
from engine.scene.bodies import MOST_PARTICLES, Box, Sphere
from engine.scene.fields import (
    Finite,
    Frozen,
    NonNegative,
    Number,
    OrOff,
    Positive,
    Vector,
    Whole,
    read_table,
    validate,
)
from engine.scene.material import FractureRules, Material

Fraction = Annotated[Number, Field(gt=0.0, le=1.0)]
Seed = Annotated[Whole, Field(ge=0)]


def _shape(body: Any) -> str:
    """Which shape of body plain keys describe."""
    is_box = isinstance(body, Box) or (isinstance(body, dict) and ("lattice" in body or "size" in body))
    return Box.__name__ if is_box else Sphere.__name__


AnyBody = Annotated[
    Annotated[Sphere, Tag(Sphere.__name__)] | Annotated[Box, Tag(Box.__name__)],
    Discriminator(_shape),
]


class Gravity(Frozen):
    """Self-gravity of all particles.

    softening: radius of the ball that stands for one particle, in units of the largest spacing h.
    interval: time [s] for which one evaluation, made at positions half of it ahead, is held.
    opening: size over distance below which a group of particles acts as a whole; 0 sums over all pairs.
    """

    softening: Positive = 1.0
    interval: Positive = 20.0
    opening: Annotated[Number, Field(ge=0.0, le=1.0)] = 0.4


class ViscosityCoefficients(Frozen):
    """Explicit viscous stress.

    shear: kinematic shear viscosity nu [m^2/s].
    bulk: kinematic bulk viscosity zeta [m^2/s].
    shock_linear, shock_quadratic: von Neumann-Richtmyer coefficients [-], in compression only.
    """

    shear: NonNegative = 0.0
    bulk: NonNegative = 0.0
    shock_linear: NonNegative = 0.0
    shock_quadratic: NonNegative = 0.0


class Wall(Frozen):
    """A rigid plane; matter is on the side that its normal points to.

    point: any point of the plane [m].
    normal: direction into the matter, of any length.
    friction: coefficient of Coulomb friction [-], 0 slips; `stick` holds whatever touches it.
    """

    point: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 0.0, 1.0)
    friction: Literal["stick"] | NonNegative = 0.0

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        if not any(self.normal):
            raise ValueError("'normal' must not be zero")
        return self


class Physics(Frozen):
    """The parts of physics a scene uses; `false` leaves a part out, and it then costs nothing.

    Pressure is that of the materials' equation of state, of one form in all bodies; without `energy` it follows the
    cold curve, and the ledger has no internal energy.
    `shear` adds the Hencky deviatoric stress, `strength` its radial return;
    `uniform_gravity` [m/s^2] takes the place of self-gravity.

    sound_speed: factor on the speed of sound, in (0, 1]; below 1 a late-stage approximation, in longer time steps, for
        motion that stays slow against the slower sound: elastic moduli are multiplied by its square, so elastic strain
        and energy grow by 1/sound_speed^2, and shocks are wrong. What is given as a stress (strength, friction,
        hydrostatic pressure, the tension that opens a flaw) stays (engine/physics.md, section 12).
    """

    energy: bool = True
    shear: bool = True
    strength: bool = True
    fracture: OrOff[FractureRules] = FractureRules()
    gravity: OrOff[Gravity] = Gravity()
    viscosity: OrOff[ViscosityCoefficients] = None
    uniform_gravity: OrOff[Vector] = None
    walls: tuple[Wall, ...] = ()
    sound_speed: Fraction = 1.0

    @model_validator(mode="after")
    def _parts_fit_together(self) -> Self:
        if self.strength and not self.shear:
            raise ValueError(
                "'strength' limits shear stress: it needs shear = true; or set strength and fracture = false"
            )
        if self.fracture and not self.strength:
            raise ValueError("'fracture' weakens strength: it needs strength = true; or set fracture = false")
        if self.gravity and self.uniform_gravity:
            raise ValueError("'uniform_gravity' takes the place of self-gravity: it needs gravity = false")
        return self


class Numerics(Frozen):
    """Resolution in space and time.

    particles_per_cell: fixes the grid, dx = h * particles_per_cell^(1/3).
    cfl: time step in units of dx / (wave speed + particle speed).
    precision: of all numbers on the device; see section 10 of engine/physics.md for what `f32` can and cannot do.
    """

    particles_per_cell: Positive = 4.0
    cfl: Fraction = 0.5
    precision: Precision = "f64"


class Output(Frozen):
    """What is written while the scene runs.

    history_interval: simulated time [s] between rows of the conserved quantities.
    snapshot_interval: simulated time [s] between particle snapshots; `false` writes none.
    """

    history_interval: Positive = 100.0
    snapshot_interval: OrOff[Positive] = 1000.0


class Scene(Frozen):
    """Everything a run depends on; the same scene gives the same results.

    period: length [m] after which space repeats along each axis, a multiple of four cells; `false` is unbounded.
    """

    physics: Physics = Physics()  # checked before bodies, whose start depends on it
    bodies: Annotated[tuple[AnyBody, ...], Field(min_length=1)]
    period: tuple[OrOff[Positive], OrOff[Positive], OrOff[Positive]] = (None, None, None)
    start_time: Finite = 0.0
    end_time: Finite
    seed: Seed = 1
    numerics: Numerics = Numerics()
    output: Output = Output()

    @field_validator("bodies")
    @classmethod
    def _bear_their_own_weight(cls, bodies: tuple[AnyBody, ...], info: ValidationInfo) -> tuple[AnyBody, ...]:
        physics = info.data.get("physics", Physics())
        gravity = physics.gravity is not None
        return tuple(body.balanced(gravity) if isinstance(body, Sphere) else body for body in bodies)

    @model_validator(mode="after")
    def _has_the_gravity_of_its_balance(self) -> Self:
        if not self.physics.gravity and any(isinstance(body, Sphere) and body.hydrostatic for body in self.bodies):
            raise ValueError(
                "'hydrostatic' pressure needs self-gravity to hold it: leave it out of the body, or set it to false"
            )
        return self

    @model_validator(mode="after")
    def _has_one_form_of_equation_of_state(self) -> Self:
        forms = sorted({body.material.eos.form for body in self.bodies})
        if len(forms) > 1:
            raise ValueError(f"'eos' must be of one form in all bodies of a scene (given {', '.join(forms)})")
        return self

    @model_validator(mode="after")
    def _ends_after_start(self) -> Self:
        if self.end_time <= self.start_time:
            raise ValueError(f"end_time {self.end_time} s is not after start_time {self.start_time} s")
        return self

    @model_validator(mode="after")
    def _particles_can_be_counted(self) -> Self:
        if self.particles > MOST_PARTICLES:
            raise ValueError(
                f"'bodies' hold {self.particles} particles in all; at most {MOST_PARTICLES} can be counted"
            )
        return self

    @model_validator(mode="after")
    def _repeats_in_whole_blocks(self) -> Self:
        for length in filter(None, self.period):
            blocks = length / (BLOCK_EDGE * self.dx)
            if round(blocks) < 1 or abs(blocks - round(blocks)) > 1e-6:
                raise ValueError(f"'period' {length} m is not a multiple of {BLOCK_EDGE} cells of {self.dx} m")
        if any(self.period) and self.physics.gravity:
            raise ValueError("'period' repeats space without end: it needs self-gravity off, physics.gravity = false")
        return self

    @property
    def period_blocks(self) -> tuple[int, int, int]:
        """Blocks after which space repeats along each axis; 0 is unbounded."""
        x, y, z = (round(length / (BLOCK_EDGE * self.dx)) if length else 0 for length in self.period)
        return x, y, z

    @property
    def materials(self) -> tuple[Material, ...]:
        """Material of every body, with the elastic moduli in force."""
        return tuple(body.material.slowed(self.physics.sound_speed) for body in self.bodies)

    @property
    def particles(self) -> int:
        """Number of particles in all bodies."""
        return sum(body.count for body in self.bodies)

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
        SceneError: neither file is there, or both are, or it is not a scene.
    """
    found = [path for path in (directory / "scene.json", directory / "scene.toml") if path.is_file()]
    if not found:
        raise SceneError(f"{directory}: holds no scene.json or scene.toml; write the scene to run there first")
    if len(found) > 1:
        raise SceneError(f"{directory}: holds scene.json and scene.toml; keep the one to run")
    return read_scene(found[0])


def scene_at(source: Path) -> Scene:
    """The scene in a file, or of a job directory.

    Raises:
        SceneError: it cannot be read.
    """
    return scene_in(source) if source.is_dir() else read_scene(source)
