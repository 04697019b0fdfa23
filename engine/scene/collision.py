"""The builder of collision scenes: two spheres meeting at a given speed and angle (engine/physics.md, section 8)."""

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import BeforeValidator, Field, ValidationInfo, field_validator, model_validator

from engine.errors import SceneError
from engine.scene.bodies import MOST_PARTICLES, Count, Sphere
from engine.scene.collision_bodies import MaterialName, Projectile, Target, rounded
from engine.scene.fields import Finite, Frozen, Number, OrOff, Positive, key
from engine.scene.input_errors import did_you_mean
from engine.scene.material import FractureRules, Material
from engine.scene.materials import CONSTANTS
from engine.scene.parameter_sets import DEFAULT, PARAMETER_SETS, over_set
from engine.scene.scene import Contact, Fraction, Gravity, Numerics, Output, Physics, Scene, Seed, ViscosityCoefficients
from engine.scene.two_body import Approach, approach_state


def _as_table(given: Any) -> Any:
    if isinstance(given, str):
        raise ValueError(f'Input should be a table, as {{name = "{given}"}}, not text')
    return given


MaterialTable = Annotated[Material, BeforeValidator(_as_table)]
"""A material whose single constants other tables can change, unlike a name alone."""


class Collision(Frozen):
    """Two spheres; t = 0 is the contact of point masses at separation R1 + R2.

    Keys that are not given are those of the parameter set. `materials` has the constants of materials by name: tables,
    laid over the shipped material that they start from as the parameter set has it, or complete models of Python, which
    stay as they are.
    """

    renamed_keys: ClassVar[dict[str, str]] = {
        "radius": "target.radius",
        "projectile_radius": "projectile.radius",
        "friction": "materials.basalt.friction",
        "material": "materials.basalt",
    }

    velocity: Annotated[Positive, key("relative speed at point-mass contact", "m s-1")]
    angle: Annotated[Number, Field(ge=0.0, le=90.0), key("impact angle, 0 is head-on", "degree")]
    target: Annotated[Target, key("the first body")] = Target()
    projectile: Annotated[Projectile, key("the second body")] = Projectile()
    materials: Annotated[dict[MaterialName, MaterialTable], key("constants of materials by name")] = Field(
        default_factory=dict, validate_default=True
    )
    particles: Annotated[Count, key("particles in the target; those of the projectile have the same spacing", "1")] = (
        20000
    )
    end_time: Annotated[Finite, key("simulated time after point-mass contact", "s")] = 15200.0
    start_separation: Annotated[
        Number,
        Field(gt=1.0, allow_inf_nan=False),
        key("distance of the centres at the start, in contact distances R1 + R2", "1"),
    ] = 2.0
    seed: Annotated[Seed, key("seed of the particles and flaws", "1")] = 1
    parameter_set: Annotated[str, key("set-up whose keys are the defaults")] = DEFAULT
    fracture: Annotated[OrOff[FractureRules], key("rules of fracture")] = FractureRules()
    gravity: Annotated[OrOff[Gravity], key("self-gravity")] = Gravity()
    contact: Annotated[OrOff[Contact], key("contact of the bodies")] = Contact()
    viscosity: Annotated[OrOff[ViscosityCoefficients], key("viscosity")] = None
    sound_speed: Annotated[Fraction, key("factor on the speed of sound, below 1 a late-stage approximation", "1")] = 1.0
    numerics: Annotated[Numerics, key("resolution in space and time")] = Numerics()
    output: Annotated[Output, key("what is written")] = Output()

    @model_validator(mode="before")
    @classmethod
    def _lies_over_its_parameter_set(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        return over_set(str(given.get("parameter_set", DEFAULT)), given)

    @field_validator("materials", mode="before")
    @classmethod
    def _have_their_names(cls, given: Any, info: ValidationInfo) -> Any:
        if not isinstance(given, dict):
            return given
        bodies = [info.data[body] for body in ("target", "projectile") if body in info.data]
        used: dict[str, Any] = {body.material: {} for body in bodies if body.material in CONSTANTS}
        tables = used | given
        return {name: {"name": name} | table if isinstance(table, dict) else table for name, table in tables.items()}

    @model_validator(mode="after")
    def _parameter_set_is_known(self) -> Self:
        if self.parameter_set not in PARAMETER_SETS:
            hint = did_you_mean(self.parameter_set, list(PARAMETER_SETS), "parameter sets")
            raise ValueError(f"unknown parameter_set '{self.parameter_set}'{hint}")
        return self

    @model_validator(mode="after")
    def _materials_are_known(self) -> Self:
        known = list(self.materials | CONSTANTS)
        for body, name in zip(("target", "projectile"), self.material_names, strict=True):
            if name not in self.materials:
                hint = did_you_mean(name, known, "materials")
                own = f'a material of your own needs a table, as materials.{name} = {{name = "basalt"}}'
                raise ValueError(f"'{body}.material': unknown material '{name}'{hint}; {own}")
        return self

    @model_validator(mode="after")
    def _ends_after_contact(self) -> Self:
        if self.end_time <= 0.0:
            raise ValueError(f"end_time counts from contact: {self.end_time} s must be greater than 0")
        return self

    @model_validator(mode="after")
    def _projectile_can_be_counted(self) -> Self:
        largest = self.target.radius * (MOST_PARTICLES / self.particles) ** (1.0 / 3.0)
        if self.projectile.radius and self.projectile.radius > largest:
            raise ValueError(
                f"'projectile.radius' {self.projectile.radius} m takes more than {MOST_PARTICLES} particles of the "
                f"target's size: give at most {largest:.3g} m, or fewer 'particles'"
            )
        return self

    def bodies_at_contact(self) -> tuple[Sphere, Sphere]:
        """Return target and projectile, both still at the origin.

        Raises:
            SceneError: a constant is unknown that strength or fracture needs, the bodies have two forms of equation of
                state or two laws of friction, or a body spins faster than its material carries waves.
        """
        materials = [self.materials[name] for name in self.material_names]
        self._require_one_law("eos.form", "equations of state of one form", [each.eos.form for each in materials])
        self._require_one_law("friction_law", "one law of friction", [each.friction_law for each in materials])
        radius, count = self.target.radius, self.particles
        small = radius if self.projectile.radius is None else self.projectile.radius
        fewer = max(1, round(count * (small / radius) ** 3))
        first, second = self.material_names
        return self._body("target", first, radius, count), self._body("projectile", second, small, fewer)

    @property
    def material_names(self) -> tuple[str, str]:
        """Names of the materials of target and projectile."""
        return self.target.material, self.projectile.material or self.target.material

    def _body(self, name: str, chosen: str, radius: float, particles: int) -> Sphere:
        given: Target | Projectile = getattr(self, name)
        material = self._complete(chosen)
        _require_slow_spin(name, given.spin_period, radius, material)
        return Sphere(
            name=name, radius=radius, particles=particles, material=material, damage=given.damage, spin=given.spin
        )

    def _require_one_law(self, key: str, law: str, laws: Sequence[str]) -> None:
        """Refuse a target and a projectile whose materials have two laws for one thing."""
        if laws[0] != laws[1]:
            first, second = self.material_names
            raise SceneError(
                f"'target.material' {first} and 'projectile.material' {second} must have {law} "
                f"('materials.{first}.{key}' is {laws[0]}, 'materials.{second}.{key}' is {laws[1]})"
            )

    def _complete(self, name: str) -> Material:
        """The material of this name, which must have all constants that the collision needs."""
        material = self.materials[name]
        for part, keys in material.lacks(("strength", *(["fracture"] if self.fracture else []))).items():
            way_out = "give them" if part == "strength" else "give them, or set fracture = false"
            raise SceneError(f"'materials.{name}' lacks {', '.join(keys)}, which {part} needs: {way_out}")
        return material

    def approach(self) -> Approach:
        """Return where the projectile starts relative to the target, and how long it takes to contact."""
        target, projectile = self.bodies_at_contact()
        contact, angle = target.radius + projectile.radius, np.deg2rad(self.angle)
        mass = target.mass + projectile.mass if self.gravity else 0.0
        position = contact * np.array([np.cos(angle), np.sin(angle), 0.0])
        velocity = np.array([-self.velocity, 0.0, 0.0])
        return approach_state(position, velocity, mass, self.start_separation * contact)

    def scene(self) -> Scene:
        """Return the scene at the start of the approach, in the frame of the centre of mass.

        Raises:
            SceneError: as for `bodies_at_contact`.
        """
        start = self.approach()
        target, projectile = self.bodies_at_contact()
        fraction = projectile.mass / (target.mass + projectile.mass)
        return Scene(
            bodies=(_moved(target, start, -fraction), _moved(projectile, start, 1.0 - fraction)),
            start_time=-rounded(start.duration),
            end_time=self.end_time,
            seed=self.seed,
            physics=Physics(
                fracture=self.fracture,
                gravity=self.gravity,
                contact=self.contact,
                viscosity=self.viscosity,
                sound_speed=self.sound_speed,
            ),
            numerics=self.numerics,
            output=self.output,
        )


def _require_slow_spin(name: str, period: float | None, radius: float, material: Material) -> None:
    """Refuse a spin whose surface is faster than longitudinal waves: 2 pi R/T > c."""
    least = 2.0 * np.pi * radius / (3600.0 * material.longitudinal_speed)
    if period is not None and period < least:
        raise SceneError(
            f"'{name}.spin_period' {period} h moves the surface faster than longitudinal waves, "
            f"{material.longitudinal_speed:.0f} m/s: give at least {1.001 * least:.4g} h"
        )


def _moved(body: Sphere, start: Approach, fraction: float) -> Sphere:
    """The body at its fraction of the relative position and velocity."""
    position = tuple(rounded(fraction * value) for value in start.position)
    velocity = tuple(rounded(fraction * value) for value in start.velocity)
    return body.model_copy(update={"position": position, "velocity": velocity})
