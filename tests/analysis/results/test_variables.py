"""What coordinates and attributes of results.nc say of themselves."""

import pytest

from analysis.results.variables import parameter


@pytest.mark.parametrize(
    ("key", "unit", "word"),
    [
        ("velocity", "m s-1", "contact"),
        ("target.spin_period", "hour", "rotation"),
        ("materials.basalt.friction", "1", "damaged"),
        ("gravity.interval", "s", "evaluations"),
        ("projectile.material", "", "target's"),
        ("case", "", "name of the case"),
        ("resolution", "", "resolution"),
    ],
)
def test_a_parameter_has_the_meaning_and_unit_of_its_key(key, unit, word):
    described = parameter(key)
    assert described.units == unit and word in described.long_name
