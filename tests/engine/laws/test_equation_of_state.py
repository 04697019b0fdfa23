"""Constants of materials on the device."""

import numpy as np
import pytest

from engine.laws.equation_of_state import MaterialConstants
from engine.scene.material import named
from tests.helpers.device import evaluate

pytestmark = pytest.mark.usefixtures("taichi")


def test_every_body_has_the_constants_and_the_density_of_its_material() -> None:
    materials = [named("basalt"), named("ice")]
    constants = MaterialConstants(materials)
    (rho0,) = evaluate(constants.rho0, np.array([0, 1, 1, 0], dtype=np.int32))
    assert rho0.tolist() == [2700.0, 917.0, 917.0, 2700.0]
    for body, material in enumerate(materials):
        for name, value in material.eos.constants().items():
            assert getattr(constants.table[body], name) == value
