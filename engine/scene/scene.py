"""A scene: the bodies, the parts of physics they obey, and how finely to resolve them. SI units throughout."""

import hashlib
import math
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
    key,
    read_table,
    validate,
)
from engine.scene.material import NEEDED, FractureRules, Material

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
    """Self-gravity of all particles (engine/physics.md, section 7)."""

    softening: Annotated[
        Positive, key("radius of the ball that stands for a particle, in the largest particle spacing", "1")
    ] = 1.0
    interval: Annotated[Positive, key("time between evaluations of gravity, made for its middle", "s")] = 20.0
    opening: Annotated[
        Number,
        Field(ge=0.0, le=1.0),
        key("size over distance below which a group of particles acts as a whole; 0 sums over all pairs", "1"),
    ] = 0.4


SPHERE_OF_A_NODE = 4.0 / 3.0 * math.pi * 1.5**3
"""Volume of the sphere that the spline of a node reaches, in cells."""


class Contact(Frozen):
    """Bodies touch where their surfaces meet, and not where they share nodes (engine/physics.md, section 1).

    Where a body is smaller than the sphere of 1.5 cells that a node reaches, bodies touch where they share nodes.
    """

    gap: Annotated[NonNegative, key("distance of surfaces at which they touch, in cells", "1")] = 0.25


class ViscosityCoefficients(Frozen):
    """Explicit viscous stress (engine/physics.md, section 6)."""

    shear: Annotated[NonNegative, key("kinematic shear viscosity", "m2 s-1")] = 0.0
    bulk: Annotated[NonNegative, key("kinematic bulk viscosity", "m2 s-1")] = 0.0
    shock_linear: Annotated[NonNegative, key("linear von Neumann-Richtmyer coefficient", "1")] = 0.0
    shock_quadratic: Annotated[NonNegative, key("quadratic von Neumann-Richtmyer coefficient", "1")] = 0.0


class Wall(Frozen):
    """A rigid plane; matter is on the side that its normal points to."""

    point: Annotated[Vector, key("any point of the plane", "m")] = (0.0, 0.0, 0.0)
    normal: Annotated[Vector, key("direction into the matter, of any length", "1")] = (0.0, 0.0, 1.0)
    friction: Annotated[
        Literal["stick"] | NonNegative, key("coefficient of Coulomb friction; `stick` stops what touches it", "1")
    ] = 0.0

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        if not any(self.normal):
            raise ValueError("'normal' must not be zero")
        return self


class Physics(Frozen):
    """The parts of physics a scene uses; `false` leaves a part out, and it then costs nothing.

    Pressure is that of the materials' equation of state, of one form in all bodies. `sound_speed` below 1 is a
    late-stage approximation in longer time steps (engine/physics.md, section 12): elastic moduli are multiplied by its
    square, so elastic strain and energy grow by 1/sound_speed^2 and shocks are wrong; what is given as a stress stays.
    """

    energy: Annotated[bool, key("internal energy; without it pressure follows the cold curve")] = True
    shear: Annotated[bool, key("Hencky's deviatoric stress")] = True
    strength: Annotated[bool, key("limit of the deviatoric stress, by radial return")] = True
    fracture: Annotated[OrOff[FractureRules], key("rules of fracture")] = FractureRules()
    gravity: Annotated[OrOff[Gravity], key("self-gravity")] = Gravity()
    contact: Annotated[OrOff[Contact], key("contact of bodies")] = Contact()
    viscosity: Annotated[OrOff[ViscosityCoefficients], key("viscosity")] = None
    uniform_gravity: Annotated[OrOff[Vector], key("acceleration in place of self-gravity", "m s-2")] = None
    walls: Annotated[tuple[Wall, ...], key("rigid planes")] = ()
    sound_speed: Annotated[Fraction, key("factor on the speed of sound", "1")] = 1.0

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
    """Resolution in space and time; the grid is dx = h particles_per_cell^(1/3) (for `f32`: physics.md, section 10)."""

    particles_per_cell: Annotated[Positive, key("particles in a cell of the grid", "1")] = 2.0
    cfl: Annotated[Fraction, key("time step in units of dx/(signal speed + particle speed): stable below 1", "1")] = 0.6
    transfer: Annotated[
        Literal["filtered", "apic"], key("transfer between particles and grid; `apic` is there to compare with")
    ] = "filtered"
    filter_time: Annotated[
        Positive,
        key(
            "time in which motion that the grid cannot represent decays, in dx/(speed of sound + speed of bodies)", "1"
        ),
    ] = 1.0
    transfer_heat: Annotated[bool, key("whether internal energy takes up what the filter dissipates")] = True
    precision: Annotated[Precision, key("precision of numbers on the device")] = "f64"


class Output(Frozen):
    """What is written while the scene runs."""

    history_interval: Annotated[Positive, key("simulated time between rows of the history", "s")] = 100.0
    snapshot_interval: Annotated[OrOff[Positive], key("simulated time between snapshots; false for none", "s")] = 1000.0


class Scene(Frozen):
    """Everything a run depends on; the same scene gives the same results."""

    physics: Annotated[Physics, key("parts of physics")] = Physics()  # checked before bodies, whose start depends on it
    bodies: Annotated[tuple[AnyBody, ...], Field(min_length=1), key("spheres and boxes")]
    period: Annotated[
        tuple[OrOff[Positive], OrOff[Positive], OrOff[Positive]],
        key("length after which space repeats along each axis, a multiple of four cells; false for none", "m"),
    ] = (None, None, None)
    start_time: Annotated[Finite, key("time at the start", "s")] = 0.0
    end_time: Annotated[Finite, key("time at the end", "s")]
    seed: Annotated[Seed, key("seed of the particles and flaws", "1")] = 1
    numerics: Annotated[Numerics, key("resolution in space and time")] = Numerics()
    output: Annotated[Output, key("what is written")] = Output()

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
                "'hydrostatic' pressure needs self-gravity to balance it: leave it out of the body, or set it to false"
            )
        return self

    @model_validator(mode="after")
    def _has_one_form_of_equation_of_state(self) -> Self:
        forms = sorted({body.material.eos.form for body in self.bodies})
        if len(forms) > 1:
            raise ValueError(f"'eos' must be of one form in all bodies of a scene (given {', '.join(forms)})")
        return self

    @model_validator(mode="after")
    def _has_one_law_of_friction(self) -> Self:
        laws = sorted({body.material.friction_law for body in self.bodies})
        if self.physics.strength and len(laws) > 1:
            raise ValueError(f"'friction_law' must be the same in all bodies of a scene (given {', '.join(laws)})")
        return self

    @model_validator(mode="after")
    def _knows_the_constants_of_its_physics(self) -> Self:
        parts = [part for part in NEEDED if getattr(self.physics, part)]
        for number, body in enumerate(self.bodies):
            for part, keys in body.material.lacks(parts).items():
                raise ValueError(
                    f"'bodies.{number}.material' ({body.material.name or 'without name'}) lacks {', '.join(keys)}, "
                    f"which 'physics.{part}' needs: give them, or set physics.{part} = false"
                )
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
                f"'bodies' have {self.particles} particles in all; at most {MOST_PARTICLES} can be counted"
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
    def separates_bodies(self) -> bool:
        """Whether bodies have motion of their own at nodes: there are several, all large enough to fill one.

        Mass does not tell what rubble that loosens fills of a node.
        """
        if any(material.critical_density for material in self.materials):
            return False
        smallest = min(body.volume for body in self.bodies) / self.dx**3
        return self.physics.contact is not None and len(self.bodies) > 1 and smallest >= SPHERE_OF_A_NODE

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
    return read_scene(scene_file(directory))


def scene_file(directory: Path) -> Path:
    """The file in a job directory that contains its scene.

    Raises:
        SceneError: there is none, or more than one.
    """
    found = [path for path in (directory / "scene.json", directory / "scene.toml") if path.is_file()]
    if not found:
        raise SceneError(f"{directory}: contains no scene.json or scene.toml; write the scene to run there first")
    if len(found) > 1:
        raise SceneError(f"{directory}: contains scene.json and scene.toml; keep the one to run")
    return found[0]


def is_hash_of(scene_hash: str, scene: Scene, directory: Path) -> bool:
    """Whether the scene of a job directory has this hash, as it means now or as its file was written.

    A version with more keys writes the same scene as another text.

    Args:
        scene_hash: as a file of the job has it.
        scene: of the directory.
        directory: the job directory.

    Raises:
        SceneError: the scene has another hash, and there is no file of it, or more than one.
    """
    return scene_hash == scene.hash() or scene_hash == hashlib.sha256(scene_file(directory).read_bytes()).hexdigest()


def scene_at(source: Path) -> Scene:
    """The scene in a file, or of a job directory.

    Raises:
        SceneError: it cannot be read.
    """
    return scene_in(source) if source.is_dir() else read_scene(source)
