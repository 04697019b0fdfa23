"""The builder of collision scenes: two spheres meeting at a given speed and angle (engine/physics.md, section 8)."""

from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, ValidationInfo, field_validator, model_validator

from engine.scene.bodies import MOST_PARTICLES, Count, Sphere
from engine.scene.fields import Finite, Frozen, NonNegative, Number, OrOff, Positive
from engine.scene.input_errors import suggestion
from engine.scene.material import PARAMETER_SETS, FractureRules, Material
from engine.scene.scene import Fraction, Gravity, Numerics, Output, Physics, Scene, Seed, ViscosityCoefficients
from engine.scene.two_body import Approach, approach


class Collision(Frozen):
    """Two spheres without spin; t = 0 is the contact of point masses at separation R1 + R2.

    velocity: relative speed at contact [m/s].
    angle: impact angle [deg], 0 is head-on.
    radius, projectile_radius: radii of target and projectile [m]; equal unless the second is given.
    particles: particles in the target; the projectile has the same mass per particle.
    end_time: simulated time after contact [s].
    start_separation: distance of the centres at the start, in contact distances R1 + R2.
    parameter_set: constants and rules of friction and fracture, `sugiura2018` or `talk`.
    friction: friction coefficient of damaged rock [-], when other than the parameter set's.
    fracture: rules of fracture that replace those of the parameter set; `false` leaves fracture out.
    sound_speed: factor on the speed of sound, see engine.scene.scene.Physics.
    """

    velocity: Positive
    angle: Annotated[Number, Field(ge=0.0, le=90.0)]
    radius: Positive = 50.0e3
    projectile_radius: Positive | None = None
    particles: Count = 20000
    end_time: Finite = 15200.0
    start_separation: Annotated[Number, Field(gt=1.0, allow_inf_nan=False)] = 2.0
    seed: Seed = 1
    parameter_set: str = "sugiura2018"
    material: Material = Material()
    friction: NonNegative | None = None
    fracture: FractureRules | Literal[False] | None = None
    gravity: OrOff[Gravity] = Gravity()
    viscosity: OrOff[ViscosityCoefficients] = None
    sound_speed: Fraction = 1.0
    numerics: Numerics = Numerics()
    output: Output = Output()

    @field_validator("fracture", mode="before")
    @classmethod
    def _rules_not_given_are_those_of_the_set(cls, given: Any, info: ValidationInfo) -> Any:
        rules = PARAMETER_SETS.get(str(info.data.get("parameter_set")))
        changes = given.model_dump(exclude_unset=True) if isinstance(given, FractureRules) else given
        return rules.fracture.model_dump() | changes if rules and isinstance(changes, dict) else given

    @field_validator("material")
    @classmethod
    def _has_no_friction_of_its_own(cls, material: Material) -> Material:
        if material.damaged_friction != Material().damaged_friction:
            raise ValueError("'damaged_friction' is the parameter set's here; give 'friction' of the collision instead")
        return material

    @model_validator(mode="after")
    def _parameter_set_is_known(self) -> Self:
        if self.parameter_set not in PARAMETER_SETS:
            hint = suggestion(self.parameter_set, list(PARAMETER_SETS), "parameter sets")
            raise ValueError(f"unknown parameter_set '{self.parameter_set}'{hint}")
        return self

    @model_validator(mode="after")
    def _ends_after_contact(self) -> Self:
        if self.end_time <= 0.0:
            raise ValueError(f"end_time counts from contact: {self.end_time} s must be greater than 0")
        return self

    @model_validator(mode="after")
    def _projectile_can_be_counted(self) -> Self:
        largest = self.radius * (MOST_PARTICLES / self.particles) ** (1.0 / 3.0)
        if self.projectile_radius and self.projectile_radius > largest:
            raise ValueError(
                f"'projectile_radius' {self.projectile_radius} m takes more than {MOST_PARTICLES} particles of the "
                f"target's size: give at most {largest:.3g} m, or fewer 'particles'"
            )
        return self

    def bodies_at_contact(self) -> tuple[Sphere, Sphere]:
        """Target and projectile, both still at the origin."""
        chosen = PARAMETER_SETS[self.parameter_set]
        friction = chosen.damaged_friction if self.friction is None else self.friction
        material = self.material.model_copy(update={"damaged_friction": friction})
        small = self.radius if self.projectile_radius is None else self.projectile_radius
        share = max(1, round(self.particles * (small / self.radius) ** 3))
        return (
            Sphere(name="target", radius=self.radius, particles=self.particles, material=material),
            Sphere(name="projectile", radius=small, particles=share, material=material),
        )

    def approach(self) -> Approach:
        """Where the projectile starts relative to the target, and how long it takes to contact."""
        target, projectile = self.bodies_at_contact()
        contact, angle = target.radius + projectile.radius, np.deg2rad(self.angle)
        mass = target.mass + projectile.mass if self.gravity else 0.0
        position = contact * np.array([np.cos(angle), np.sin(angle), 0.0])
        velocity = np.array([-self.velocity, 0.0, 0.0])
        return approach(position, velocity, mass, self.start_separation * contact)

    def scene(self) -> Scene:
        """The scene at the start of the approach, in the frame of the centre of mass."""
        start = self.approach()
        target, projectile = self.bodies_at_contact()
        rules = PARAMETER_SETS[self.parameter_set].fracture if self.fracture is None else self.fracture
        fraction = projectile.mass / (target.mass + projectile.mass)
        return Scene(
            bodies=(_moved(target, start, -fraction), _moved(projectile, start, 1.0 - fraction)),
            start_time=-rounded(start.duration),
            end_time=self.end_time,
            seed=self.seed,
            physics=Physics(
                fracture=rules or None,
                gravity=self.gravity,
                viscosity=self.viscosity,
                sound_speed=self.sound_speed,
            ),
            numerics=self.numerics,
            output=self.output,
        )


def _moved(body: Sphere, start: Approach, share: float) -> Sphere:
    """The body at its share of the relative position and velocity."""
    position = tuple(rounded(share * value) for value in start.position)
    velocity = tuple(rounded(share * value) for value in start.velocity)
    return body.model_copy(update={"position": position, "velocity": velocity})


def rounded(value: float) -> float:
    """Ten digits of a number: the same collision is then the same scene, and the same job, on every machine."""
    return float(f"{value:.9e}")
