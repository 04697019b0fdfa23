"""What the published parameter sets mean for the laws."""

from engine.scene.collision import Collision
from engine.scene.material import FractureRules


def rules_of(name: str) -> FractureRules:
    """Rules of fracture of a set."""
    rules = Collision(velocity=1.0, angle=0.0, parameter_set=name).fracture
    assert rules is not None
    return rules


def friction_of(name: str) -> float:
    """Friction coefficient of damaged basalt [-] of a set."""
    return Collision(velocity=1.0, angle=0.0, parameter_set=name).materials["basalt"].known("friction")
