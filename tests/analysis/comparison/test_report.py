"""A campaign beside other methods: its rows, tables and figure."""

from pathlib import Path

import matplotlib.image
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from typer.testing import CliRunner

from analysis.cli import app
from analysis.comparison.figure import beside_other_methods
from analysis.comparison.report import markdown
from analysis.comparison.rows import FRICTION, MEASURED, OWN, REFERENCES, compared, references
from engine.errors import SceneError
from engine.scene.collision import Collision
from tests.helpers.fake_jobs import lattice_ellipsoid, particles, write_campaign, write_job


def results(**attrs: object) -> xr.Dataset:
    """Two collisions, two laws and three seeds; values are the number of the run, one run has failed."""
    dims, shape = ("case", "law", "seed"), (2, 2, 3)
    values = np.arange(12.0).reshape(shape)
    state = np.full(shape, "done", dtype=object)
    state[1, 1, 2], values[1, 1, 2] = "failed", np.nan
    numbers = dict.fromkeys((*MEASURED, "time_after_contact"), (dims, values))
    coords = {
        "case": ["fast", "slow"],
        "law": ["one", "other"],
        "seed": [1, 2, 3],
        "velocity": (dims, np.broadcast_to([[[200.0]], [[50.0]]], shape)),
        "angle": (dims, np.broadcast_to([[[5.0]], [[30.0]]], shape)),
    }
    basalt = {"target.radius": 5e4, "projectile.radius": "none", "materials.basalt.rho0": 2700.0, "particles": 2000}
    return xr.Dataset({**numbers, "state": (dims, state)}, coords=coords, attrs={**basalt, **attrs})


def test_rows_of_a_campaign_are_means_over_seeds_beside_others_of_the_same_collision() -> None:
    rows = compared(results())
    own = rows[rows["method"] == OWN]
    assert own["material"].tolist() == ["one", "other", "one", "other"]
    assert own["mass_ratio"].tolist() == [1.0, 4.0, 7.0, 9.5]
    np.testing.assert_allclose(own["mass_ratio_spread"], [1.0, 1.0, 1.0, np.sqrt(0.5)])
    assert own["runs"].tolist() == [3, 3, 3, 2] and (own["particles"] == 2000).all()
    assert set(map(tuple, rows[["velocity", "angle"]].to_numpy())) == {(200.0, 5.0), (50.0, 30.0)}
    assert rows["velocity"].is_monotonic_decreasing, "in the order of the campaign"
    others = rows[rows["method"].isin(references()["method"])]
    wanted = references().query("(velocity == 200 and angle == 5) or velocity == 50")
    assert len(others) == len(wanted) > 5
    bound = rows[rows["method"] == "scaling"]["bound_mass_ratio"]
    np.testing.assert_allclose(bound, [1.24, 2.0], atol=0.005)


@pytest.mark.parametrize(
    ("attributes", "methods"),
    [
        ({"target.radius": 5e2}, {OWN, "scaling"}),
        ({"projectile.radius": 3e4}, {OWN, "scaling"}),
        ({"target.radius": "none"}, {OWN}),
        ({"materials.ice.rho0": 917.0}, {OWN, "scaling", *references()["method"]} - {"scaling"}),
    ],
)
def test_other_bodies_have_no_references_and_several_materials_no_scaling(
    attributes: dict[str, object], methods: set[str]
) -> None:
    assert set(compared(results(**attributes))["method"]) == methods


def test_cases_of_one_collision_are_told_apart_by_their_names() -> None:
    both = results()
    both = both.assign_coords(velocity=0.0 * both["velocity"] + 200.0, angle=0.0 * both["angle"] + 5.0)
    own = compared(both)
    assert own[own["method"] == OWN]["material"].tolist() == ["fast, one", "fast, other", "slow, one", "slow, other"]


def test_rows_say_the_size_and_the_friction_that_vary_between_cases() -> None:
    both, dims = results(), ("case", "law", "seed")
    del both.attrs["particles"]
    zero = xr.zeros_like(both["velocity"])
    varied = both.assign_coords(
        {
            "particles": (zero + xr.DataArray([2000.0, 5000.0], dims="case")).transpose(*dims),
            FRICTION: (zero + xr.DataArray([0.5, 0.65], dims="case")).transpose(*dims),
        }
    )
    own = compared(varied).query("method == @OWN")
    assert own["particles"].tolist() == [2000, 2000, 5000, 5000]
    assert own["material"].tolist()[1:3] == ["other, friction 0.5", "one, friction 0.65"]


def test_references_are_complete_and_possible() -> None:
    table = pd.read_csv(REFERENCES)
    assert table["source"].notna().all() and table[["velocity", "angle", "method", "particles"]].notna().all(axis=None)
    assert (table["c_over_a"] <= table["b_over_a"]).all() and (table["b_over_a"] <= 1.0).all()
    assert (table[["mass_ratio", "bound_mass_ratio"]].max() <= 2.0).all()
    assert not (table["mass_ratio"] > table["bound_mass_ratio"]).any()


def test_tables_and_figure_show_every_row() -> None:
    rows = compared(results())
    text = markdown(rows)
    assert "200 m/s, 5 deg" in text and "| this study, one | 2 x 2,000 | 3 | 1 | 1.00 +- 1.00 |" in text
    assert text.count("\n| ") == len(rows) + 4
    figure = beside_other_methods(rows)
    assert len(figure.axes) == 8 and "this study, other" in [t.get_text() for t in figure.legends[0].get_texts()]


@pytest.mark.parametrize("changed", [{"dims": ("case", "law")}, {"dims": ("law", "seed")}])
def test_a_campaign_of_other_dimensions_is_refused(changed: dict[str, tuple[str, ...]]) -> None:
    lost = ({"case", "law", "seed"} - set(changed["dims"])).pop()
    with pytest.raises(SceneError, match="needs"):
        compared(results().isel({lost: 0}, drop=True))


def test_a_campaign_without_a_finished_run_is_refused() -> None:
    empty = results()
    empty["mass_ratio"] = xr.full_like(empty["mass_ratio"], np.nan)
    with pytest.raises(SceneError, match="no run"):
        compared(empty)


def test_the_command_compares_a_campaign(tmp_path: Path) -> None:
    made = [Collision(velocity=200.0, angle=5.0, seed=seed, parameter_set="rubble") for seed in (1, 2)]
    jobs = [({"case": "200-5", "seed": collision.seed}, collision) for collision in made]
    write_campaign(tmp_path, {"case": ["200-5"], "seed": [1, 2]}, jobs)
    for number, collision in enumerate(made):
        points, spacing = lattice_ellipsoid((1e5 + 1e4 * number, 1e5, 8e4), 150)
        write_job(tmp_path / f"jobs/{number}", collision, particles(points, spacing, time=900.0))
    told = CliRunner().invoke(app, ["comparison", str(tmp_path)])
    assert told.exit_code == 0, told.output
    assert (tmp_path / "comparison.md").read_text() in told.output and "| this study |" in told.output
    assert matplotlib.image.imread(tmp_path / "comparison.png").shape[0] > 200
