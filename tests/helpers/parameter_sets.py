"""What the published parameter sets mean for the laws."""

from engine.scene.material import FractureRules
from engine.scene.parameter_sets import PARAMETER_SETS


def rules_of(name: str) -> FractureRules:
    """Rules of fracture of a set."""
    return FractureRules.model_validate(PARAMETER_SETS[name]["fracture"])


def friction_of(name: str) -> float:
    """Friction coefficient of damaged basalt [-] of a set."""
    return float(PARAMETER_SETS[name]["materials"]["basalt"]["friction"])
