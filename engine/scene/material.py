"""Constants of a material, and rules of its fracture (engine/physics.md, sections 2-5)."""

from collections.abc import Iterable
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import (
    Discriminator,
    Field,
    SerializerFunctionWrapHandler,
    Tag,
    model_serializer,
    model_validator,
)

from engine.scene.fields import Frozen, NonNegative, Number, Positive, key
from engine.scene.input_errors import did_you_mean
from engine.scene.materials import CONSTANTS
from engine.scene.murnaghan import MurnaghanParameters
from engine.scene.tables import overlay
from engine.scene.tillotson import TillotsonParameters


def _form(given: Any) -> str:
    """Form of an equation of state given as plain keys or as a model; Tillotson's unless it is named."""
    return str(given.get("form", "tillotson") if isinstance(given, dict) else getattr(given, "form", "tillotson"))


AnyEquationOfState = Annotated[
    Annotated[TillotsonParameters, Tag("tillotson")] | Annotated[MurnaghanParameters, Tag("murnaghan")],
    Discriminator(_form, "form", "'form' must be 'tillotson' or 'murnaghan'"),
]
"""Constants of an equation of state; their key `form` chooses which, Tillotson's if it is not given."""

LARGEST_FRICTION = 1.722
"""sqrt(J2)/P in triaxial compression at a friction angle of 85 degrees."""

NEEDED = {
    "strength": ("cohesion", "intact_friction", "strength_limit", "melt_energy", "friction"),
    "fracture": ("weibull_k", "weibull_m"),
}
"""Constants without which a part of physics cannot be, by the part's key."""


PACKING = ("critical_density", "dilatancy", "crushing_pressure")
"""Keys that a material does not write where they are not set: scenes from before they existed keep their hash."""


class Material(Frozen):
    """Constants of one solid; those of parts that a scene leaves out may be unknown.

    Given as the name of a shipped material (engine.scene.materials), as a table with such a `name` whose keys are laid
    over it, or as a complete table of its own.
    """

    renamed_keys: ClassVar[dict[str, str]] = {"damaged_friction": "friction", "tillotson": "eos"}

    name: Annotated[str | None, key("material from whose constants it starts")] = None
    rho0: Annotated[Positive, key("reference density", "kg m-3")]
    eos: Annotated[AnyEquationOfState, key("equation of state")]
    shear_modulus: Annotated[Positive, key("shear modulus G", "Pa")]
    cohesion: Annotated[NonNegative | None, key("cohesion Y0 of intact rock", "Pa")] = None
    intact_friction: Annotated[NonNegative | None, key("friction coefficient mu_i of intact rock", "1")] = None
    strength_limit: Annotated[Positive | None, key("limit Y_M of intact strength under pressure", "Pa")] = None
    melt_energy: Annotated[Positive | None, key("specific energy u_melt at which strength vanishes", "J kg-1")] = None
    friction: Annotated[NonNegative | None, key("friction coefficient mu_d = sqrt(J2)/P of damaged rock", "1")] = None
    friction_law: Annotated[
        Literal["drucker-prager", "mohr-coulomb", "matsuoka-nakai"],
        key("how friction depends on the direction of shear; `friction` is that of triaxial compression"),
    ] = "drucker-prager"
    critical_density: Annotated[
        Positive | None,
        key("density rho_c to which shear loosens broken rock; without it, it stays as dense", "kg m-3"),
    ] = None
    dilatancy: Annotated[
        Positive | None, key("largest plastic dilation by plastic shear; `friction` falls by it towards rho_c", "1")
    ] = None
    crushing_pressure: Annotated[
        Positive | None, key("pressure at which shear leaves half of the pores of rho_c", "Pa")
    ] = None
    weibull_k: Annotated[Positive | None, key("Weibull coefficient k: flaws per volume, k strain^m", "m-3")] = None
    weibull_m: Annotated[
        Annotated[Number, Field(ge=1.0, allow_inf_nan=False)] | None, key("Weibull exponent m of flaws", "1")
    ] = None

    @model_serializer(mode="wrap")
    def _without_unset_packing(self, serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        table: dict[str, Any] = serialize(self)
        return {name: value for name, value in table.items() if name not in PACKING or value is not None}

    @model_validator(mode="before")
    @classmethod
    def _starts_from_its_namesake(cls, given: Any) -> Any:
        table = {"name": given} if isinstance(given, str) else given
        if not isinstance(table, dict):
            return table
        name = table.get("name")
        if not isinstance(name, str | None):
            raise ValueError(f"'name' must be text (given {name!r})")
        if name in CONSTANTS:
            return overlay(CONSTANTS[name], table)
        absent = [key for key, field in cls.model_fields.items() if field.is_required() and key not in table]
        if absent and not cls.renamed_keys.keys() & table.keys():
            raise ValueError(_incomplete(name, absent))
        return table

    @model_validator(mode="after")
    def _strengthens_with_pressure(self) -> Self:
        if self.strength_limit is not None and self.cohesion is not None and self.strength_limit <= self.cohesion:
            raise ValueError(f"'strength_limit' {self.strength_limit} Pa must exceed 'cohesion' {self.cohesion} Pa")
        return self

    @model_validator(mode="after")
    def _has_a_friction_angle(self) -> Self:
        if self.friction_law != "drucker-prager" and self.friction is not None and self.friction >= LARGEST_FRICTION:
            raise ValueError(
                f"'friction' {self.friction} must be below {LARGEST_FRICTION}, that of 85 degrees, with friction_law = "
                f"'{self.friction_law}': a friction angle phi has 2 sqrt(3) sin(phi)/(3 - sin(phi))"
            )
        return self

    @model_validator(mode="after")
    def _loosens_and_dilates(self) -> Self:
        absent = [name for name in PACKING if getattr(self, name) is None]
        if 0 < len(absent) < len(PACKING):
            raise ValueError(f"'{', '.join(PACKING)}' belong together: give all or none (absent: {', '.join(absent)})")
        if self.critical_density is not None and not 0.5 * self.rho0 <= self.critical_density < self.rho0:
            raise ValueError(
                f"'critical_density' {self.critical_density} kg/m3 must be below 'rho0' {self.rho0} kg/m3, "
                "and at least half of it"
            )
        if self.dilatancy is not None and (self.friction is None or self.dilatancy > 0.5 * self.friction):
            raise ValueError(
                f"'dilatancy' {self.dilatancy} must be at most half of 'friction', {self.friction}: rubble looser than "
                "critical has friction - 2 dilatancy"
            )
        return self

    def lacks(self, parts: Iterable[str]) -> dict[str, list[str]]:
        """Return the unknown constants that parts of physics need, by part; parts that miss nothing are left out.

        Args:
            parts: keys of `NEEDED`.
        """
        absent = {part: [key for key in NEEDED[part] if getattr(self, key) is None] for part in parts}
        return {part: keys for part, keys in absent.items() if keys}

    def known(self, constant: str) -> float:
        """Return a constant that may be unknown.

        Raises:
            ValueError: it is unknown.
        """
        value = getattr(self, constant)
        if value is None:
            raise ValueError(f"material {self.name or 'without name'} has no '{constant}'")
        return float(value)

    @property
    def longitudinal_modulus(self) -> float:
        """K + 4G/3 [Pa] at the reference state."""
        return self.eos.bulk_modulus() + 4.0 / 3.0 * self.shear_modulus

    @property
    def longitudinal_speed(self) -> float:
        """Speed of longitudinal waves [m/s] at the reference state."""
        return float((self.longitudinal_modulus / self.rho0) ** 0.5)

    @property
    def signal_speed(self) -> float:
        """Speed sqrt(max(3 K, 2 G)/rho0) [m/s] that limits time steps at rest (engine/physics.md, section 1)."""
        return float((max(3.0 * self.eos.bulk_modulus(), 2.0 * self.shear_modulus) / self.rho0) ** 0.5)

    @property
    def young_modulus(self) -> float:
        """9KG/(3K+G) [Pa] at the reference state."""
        bulk, shear = self.eos.bulk_modulus(), self.shear_modulus
        return 9.0 * bulk * shear / (3.0 * bulk + shear)

    def slowed(self, factor: float) -> Self:
        """Return the same solid with moduli in which waves travel at `factor` [-] of their speed; strength stays."""
        shear = factor**2 * self.shear_modulus
        return self.model_copy(update={"eos": self.eos.softened(factor), "shear_modulus": shear})


def named(name: str, **changes: Any) -> Material:
    """Return a shipped material, with other values for some of its constants.

    Args:
        name: `basalt` or `ice`.
        changes: constants by key of `Material`; a table or model for `eos`.
    """
    return Material.model_validate({"name": name, **changes})


def _incomplete(name: Any, absent: list[str]) -> str:
    """What to tell of a table that neither is complete nor names a shipped material."""
    keys = ", ".join(absent)
    if name is None:
        return f"a material without 'name' must give {keys}; or name one to start from: {', '.join(CONSTANTS)}"
    hint = did_you_mean(str(name), list(CONSTANTS), "materials")
    return f"unknown material '{name}' (one of your own must give {keys}){hint}"


class FractureRules(Frozen):
    """Weibull flaws and Grady-Kipp damage growth (engine/physics.md, section 5).

    `covered` draws flaws until every particle has one, `2NlnN` draws that many. D never exceeds the fraction of the
    particle's flaws that are active.
    """

    flaws: Annotated[Literal["covered", "2NlnN"], key("how many flaws a body has")] = "covered"
    strain: Annotated[
        Literal["longitudinal", "young"], key("modulus that turns the largest tensile stress into local strain")
    ] = "longitudinal"
    growth_speed: Annotated[Positive, key("crack speed in units of the longitudinal sound speed", "1")] = 0.4
    growth_range: Annotated[Positive, key("distance a crack runs to break a particle, in particle spacings", "1")] = 3.0
    per_flaw: Annotated[bool, key("whether a crack grows from every active flaw at once, instead of one")] = True
