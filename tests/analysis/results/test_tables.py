"""Names of series in tables and figures."""

import xarray as xr

from analysis.results.tables import series


def titles(**coords: list[float]) -> list[str]:
    """Names of the series of a campaign over some axes, whose names have _ for a dot."""
    names = {key.replace("__", "."): values for key, values in coords.items()}
    shape = tuple(map(len, names.values()))
    state = xr.DataArray([["done"] * shape[1]] * shape[0], dims=list(names), coords=names)
    return [title for title, _ in series(xr.Dataset({"state": state}, coords={"velocity": 200.0, "angle": 15.0}))]


def test_a_constant_of_the_only_material_goes_by_its_last_part() -> None:
    found = titles(materials__basalt__friction=[0.4, 0.8], target__spin_period=[4.0, 8.0])
    assert found[0] == "friction 0.4, target.spin_period 4" and len(found) == 4


def test_the_same_constant_of_two_materials_keeps_their_names() -> None:
    found = titles(materials__basalt__friction=[0.4, 0.8], materials__ice__friction=[0.2, 0.3])
    assert found[0] == "materials.basalt.friction 0.4, materials.ice.friction 0.2"


def test_a_parameter_that_some_points_lack_is_none_there() -> None:
    assert titles(target__spin_period=[float("nan"), 8.0], seed=[1.0])[0] == "target.spin_period none"
