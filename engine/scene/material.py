"""Material constants and the two published parameter sets (engine/physics.md, sections 2-5)."""

from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from engine.scene.fields import Frozen, NonNegative, Number, Positive
from engine.scene.input_errors import suggestion
from engine.scene.murnaghan import MurnaghanParameters
from engine.scene.tillotson import TillotsonParameters


def _form(given: Any) -> str | None:
    """Name of the model that plain keys, or a model, describe; Tillotson's unless they name a form."""
    form = given.get("form", "tillotson") if isinstance(given, dict) else getattr(given, "form", "tillotson")
    return f"{form}".capitalize() + "Parameters"


AnyEquationOfState = Annotated[
    Annotated[TillotsonParameters, Tag(TillotsonParameters.__name__)]
    | Annotated[MurnaghanParameters, Tag(MurnaghanParameters.__name__)],
    Discriminator(_form, "form", "'form' must be 'tillotson' or 'murnaghan'"),
]
"""Constants of an equation of state; their key `form` chooses which, Tillotson's if it is not given."""


class Material(Frozen):
    """One solid [SI units]; the defaults are basalt with the constants of Sugiura et al. 2018."""

    rho0: Positive = 2700.0
    eos: AnyEquationOfState = TillotsonParameters()
    shear_modulus: Positive = 2.27e10
    cohesion: NonNegative = 1.0e7
    intact_friction: NonNegative = 1.0
    strength_limit: Positive = 3.5e9
    melt_energy: Positive = 3.4e6
    damaged_friction: NonNegative = 0.839
    weibull_k: Positive = 4.0e35
    weibull_m: Annotated[Number, Field(ge=1.0, allow_inf_nan=False)] = 9.0

    @model_validator(mode="before")
    @classmethod
    def _names_its_equation_of_state(cls, given: Any) -> Any:
        if isinstance(given, dict) and "tillotson" in given:
            raise ValueError(f"unknown key 'tillotson'{suggestion('eos', list(cls.model_fields))}")
        return given

    @model_validator(mode="after")
    def _strengthens_with_pressure(self) -> Self:
        if self.strength_limit <= self.cohesion:
            raise ValueError(f"'strength_limit' {self.strength_limit} Pa must exceed 'cohesion' {self.cohesion} Pa")
        return self

    @property
    def longitudinal_modulus(self) -> float:
        """K + 4G/3 [Pa] at the reference state."""
        return self.eos.bulk_modulus() + 4.0 / 3.0 * self.shear_modulus

    @property
    def longitudinal_speed(self) -> float:
        """Speed of longitudinal waves [m/s] at the reference state."""
        return float((self.longitudinal_modulus / self.rho0) ** 0.5)

    @property
    def young_modulus(self) -> float:
        """9KG/(3K+G) [Pa] at the reference state."""
        bulk, shear = self.eos.bulk_modulus(), self.shear_modulus
        return 9.0 * bulk * shear / (3.0 * bulk + shear)

    def slowed(self, factor: float) -> Self:
        """The same solid with elastic moduli that let waves travel at `factor` of their speed; its strength stays."""
        shear = factor**2 * self.shear_modulus
        return self.model_copy(update={"eos": self.eos.softened(factor), "shear_modulus": shear})


class FractureRules(Frozen):
    """Weibull flaws and Grady-Kipp damage growth (engine/physics.md, section 5).

    flaws: `covered` draws flaws until every particle holds one, `2NlnN` draws that many.
    strain: modulus that turns the largest tensile stress into the local strain.
    growth_speed: crack speed in units of the longitudinal sound speed.
    growth_range: distance R_s a crack runs to break one particle, in particle spacings h.
    per_flaw: cracks grow from every active flaw at once, so the rate is n_act times one crack's.
    In both, D never exceeds the share of the particle's flaws that are active.
    """

    flaws: Literal["covered", "2NlnN"] = "covered"
    strain: Literal["longitudinal", "young"] = "longitudinal"
    growth_speed: Positive = 0.4
    growth_range: Positive = 3.0
    per_flaw: bool = True


class ParameterSet(Frozen):
    """Everything in which two published set-ups of the same collision differ."""

    damaged_friction: float
    fracture: FractureRules


PARAMETER_SETS = {
    "sugiura2018": ParameterSet(damaged_friction=0.839, fracture=FractureRules()),
    "talk": ParameterSet(
        damaged_friction=0.945,
        fracture=FractureRules(flaws="2NlnN", strain="young", growth_speed=0.5, per_flaw=False),
    ),
}
