"""Accuracy of cases: closed forms of means, differences and orders, and what the command writes."""

from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import same_color
from typer.testing import CliRunner

from analysis.accuracy.cases import VariedCase, cases
from analysis.accuracy.figure import error_against_cost, errors, looks_of
from analysis.accuracy.measure import accuracy
from analysis.accuracy.report import markdown
from analysis.cli import app
from analysis.remnant.variables import OUTCOMES
from campaigns.campaign import KeptCampaign, read_campaign
from campaigns.expansion import expand
from campaigns.study import find_study, read_study
from engine.errors import SceneError
from engine.job.storage import read_dataset, write_json
from engine.scene.collision import Collision
from tests.helpers.fake_jobs import lattice_ellipsoid, particles, write_campaign, write_job

COUNTS = {"particles500": 500, "base": 1000, "particles4000": 4000, "particles32000": 32000}
SCATTER = np.array([-1.0, 0.0, 1.0])


def known() -> dict[str, VariedCase]:
    resolutions = {name: VariedCase("none" if name == "base" else "particles", n, n) for name, n in COUNTS.items()}
    return resolutions | {"cfl": VariedCase("numerics.cfl", 0.9, 1000)}


def results(scatter: float) -> xr.Dataset:
    """Outcomes 5 + 3 h^2 with a scatter over three seeds; the last case is the base with 1 more."""
    names = list(known())
    spacing = np.array([(4.0 * np.pi / 3.0 / known()[name].particles) ** (1.0 / 3.0) for name in names])
    values = (5.0 + 3.0 * spacing**2 + np.array([0.0, 0.0, 0.0, 0.0, 1.0]))[:, None] + scatter * SCATTER
    numbers = {name: (("case", "seed"), values, variable.attributes()) for name, variable in OUTCOMES.items()}
    numbers |= {name: (("case", "seed"), 0.0 * values + 0.1 * spacing[:, None]) for name in OUTCOMES if "drift" in name}
    state = (("case", "seed"), np.full(values.shape, "done", dtype=object))
    return xr.Dataset({**numbers, "state": state}, coords={"case": names, "seed": [1, 2, 3]})


def test_differences_and_their_verdict() -> None:
    found = accuracy(results(0.1), known())
    half = 4.302653 * 0.1 / np.sqrt(3.0)  # Student's t of two degrees of freedom
    np.testing.assert_allclose(found["b_over_a_interval"], half, rtol=1e-6)
    cfl = found.sel(case="cfl")
    assert cfl["b_over_a_minus_base"] == pytest.approx(1.0)
    assert cfl["b_over_a_minus_base_interval"] == pytest.approx(0.0, abs=1e-12)  # same bodies, seed by seed
    assert cfl["b_over_a_minus_base_resolved"] == 1.0
    assert cfl["b_over_a_minus_finest_interval"] == pytest.approx(np.sqrt(2.0) * half)
    assert found.sel(case="particles500")["b_over_a_minus_base_interval"] == pytest.approx(np.sqrt(2.0) * half)
    assert found.sel(case="particles500")["b_over_a_minus_base_resolved"] == 0.0
    assert np.isnan(found.sel(case="base")["b_over_a_minus_base"])
    assert found.attrs["finest"] == "particles32000" and np.isnan(
        found.sel(case="particles32000")["b_over_a_minus_finest"]
    )


def test_orders_are_those_of_the_data() -> None:
    found = accuracy(results(1e-6), known())
    assert found["refinement"].values.tolist() == ["500 to 1000", "1000 to 4000", "4000 to 32000"]
    np.testing.assert_allclose(found["order_b_over_a"], [2.0, 2.0, np.nan], rtol=1e-3)
    np.testing.assert_allclose(found["order_drift_energy"], 1.0, rtol=1e-9)


def test_orders_that_seeds_do_not_resolve_are_unknown() -> None:
    assert accuracy(results(1.0), known())["order_b_over_a"].isnull().all()


def test_an_error_that_seeds_hide_is_their_interval() -> None:
    found = accuracy(results(0.1), known())
    frame = errors(found, "b_over_a")
    assert frame.loc["cfl", "resolved"] and frame.loc["cfl", "error"] == pytest.approx(frame.loc["cfl", "change"])
    assert not frame.loc["base", "resolved"] and frame.loc["base", "error"] == frame.loc["base", "half"]
    assert "particles32000" not in frame.index


def test_runs_that_are_not_done_do_not_count() -> None:
    some = results(0.1)
    some["state"][4, :] = "failed"
    some["state"][0, 1:] = "pending"
    for name in OUTCOMES:
        some[name] = some[name].where(some["state"] == "done")
    found = accuracy(some, known())
    assert found["runs"].values.tolist() == [1, 3, 3, 3] and "cfl" not in found["case"]
    assert np.isfinite(found["b_over_a_minus_base_interval"].sel(case="particles500"))
    assert "1 cases of the study have no finished run" in markdown(found, 5)


def test_the_shipped_study_varies_one_setting_a_case_but_for_shock_viscosity_and_contact(tmp_path: Path) -> None:
    write_json(tmp_path / "campaign.json", expand(read_study(find_study("accuracy")), "accuracy").content())
    found = cases(read_campaign(tmp_path, KeptCampaign))
    assert found["base"].setting == "none"
    assert [name for name, case in found.items() if case.setting == "several"] == ["contact-none", "shock-viscosity"]
    assert found["viscosity.shear350000"] == VariedCase("viscosity.shear", 3.5e5, 1000)
    assert found["particles20000"].particles == 20000


def test_the_command_writes_data_figure_and_tables(tmp_path: Path) -> None:
    settings = {"base": {}, "fine": {"particles": 400}, "viscous": {"viscosity": {"shear": 1e5}}}
    jobs = [
        (
            {"case": name, "seed": seed},
            Collision(velocity=200.0, angle=15.0, seed=seed, **{"particles": 200, **changes}),
        )
        for name, changes in settings.items()
        for seed in (1, 2)
    ]
    write_campaign(tmp_path, {"case": list(settings), "seed": [1, 2]}, jobs)
    for number, (_, made) in enumerate(jobs):
        points, spacing = lattice_ellipsoid((1e5 + 1e4 * number, 1e5, 8e4), 150)
        write_job(tmp_path / f"jobs/{number}", made, particles(points, spacing, time=900.0))
    told = CliRunner().invoke(app, ["accuracy", str(tmp_path)])
    assert told.exit_code == 0, told.output
    assert (tmp_path / "accuracy.md").read_text() in told.output and "| viscous | 2 |" in told.output
    found = read_dataset(tmp_path / "accuracy.nc")
    assert found["setting"].values.tolist() == ["none", "particles", "viscosity.shear"]
    assert all(found[name].attrs["units"] for name in found.data_vars)
    assert matplotlib.image.imread(tmp_path / "accuracy.png").shape[0] > 500


def test_the_figure_shows_the_error_of_each_case_against_its_time_and_what_no_other_case_beats() -> None:
    some = results(0.1)
    some["cpu_time"] = ("case", "seed"), np.outer([1.0, 2.0, 8.0, 64.0, 3.0], np.ones(3))
    found = accuracy(some, known())
    figure = error_against_cost(found)
    titles = ["$M_\\mathrm{lr}\\,/\\,M_\\mathrm{target}$", "$b/a$", "$c/a$", "bulk density [kg m-3]"]
    assert [axes.get_title() for axes in figure.axes] == titles
    assert (figure.get_supxlabel(), figure.get_supylabel()) == ("CPU time of a run [s]", "difference to particles32000")
    frame = errors(found, "b_over_a")
    for axes in figure.axes:
        assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
        front, *points = axes.lines
        drawn = {(float(line.get_xdata()[0]), float(line.get_ydata()[0])) for line in points}
        assert drawn == set(zip(frame["cpu_time"], frame["error"], strict=True)), "all outcomes here are the same"
        assert set(zip(front.get_xdata(), front.get_ydata(), strict=True)) < drawn
        hollow = [line for line in points if same_color(line.get_markerfacecolor(), "white")]
        assert len(hollow) == (~frame["resolved"]).sum() > 0
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert legend == ["particles", "base", "numerics.cfl", "not resolved", "no case beats these"]


def test_more_settings_than_colours_look_different() -> None:
    settings = [f"setting {number}" for number in range(40)]
    looks = looks_of([*settings, settings[0]])
    assert list(looks) == settings
    assert len({(*colour, marker) for colour, marker in looks.values()}) == 40


@pytest.mark.parametrize(
    ("coords", "told"), [({"case": ["a"]}, "axis seed"), ({"case": ["a"], "seed": [1]}, "no case 'base'")]
)
def test_another_campaign_is_refused(tmp_path: Path, coords: dict[str, list[object]], told: str) -> None:
    write_campaign(
        tmp_path, coords, [({key: values[0] for key, values in coords.items()}, Collision(velocity=1, angle=5))]
    )
    with pytest.raises(SceneError, match=told):
        cases(read_campaign(tmp_path, KeptCampaign))
