"""Studies with error bars: what two resolutions and several seeds make of a cell."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from analysis.remnant.variables import OUTCOMES
from analysis.report.figures import angle as shape_versus_angle
from analysis.report.products import plots
from analysis.results.collect import collect
from analysis.results.error_bars import combine
from analysis.results.tables import printed, shape_table, unresolved
from campaigns.members import ErrorBars
from engine.errors import SceneError
from engine.job.storage import read_dataset
from engine.scene.collision import Collision
from tests.helpers.fake_jobs import lattice_ellipsoid, particles, write_campaign, write_job

COORDS = {"velocity": [200.0], "angle": [5.0, 15.0], "resolution": ["coarse", "fine"], "seed": [1, 2]}

BARS = {"coarser": 0.5, "seeds": [1, 2]}


def campaign(
    directory: Path, missing: tuple[tuple[float, str, int], ...] = (), state: str = "pending", bars: Any = BARS
) -> Path:
    """Two cells of four members; every member's remnant has its own axis ratios."""
    jobs: list[tuple[dict[str, Any], Collision]] = []
    for angle in (5.0, 15.0):
        for resolution, count in (("coarse", 100), ("fine", 200)):
            for seed in (1, 2):
                place = {"velocity": 200.0, "angle": angle, "resolution": resolution, "seed": seed}
                made = Collision(velocity=200.0, angle=angle, particles=count, seed=seed, end_time=1000.0)
                jobs.append((place, made))
    write_campaign(directory, COORDS, jobs, error_bars=bars)
    for number, (place, made) in enumerate(jobs):
        points, spacing = lattice_ellipsoid((1e5 + 1e4 * number, 1e5, 8e4), 150)
        final = particles(points, spacing, time=900.0)
        if (place["angle"], place["resolution"], place["seed"]) in missing:
            write_job(directory / f"jobs/{number}", made, None, state, "too hot" if state == "failed" else "")
        else:
            write_job(directory / f"jobs/{number}", made, final)
    return directory


def cell_of(fine: list[float], coarse: list[float], order: float = 3.0) -> xr.Dataset:
    """One cell as combined: of order 3 in spacing, half the particles make the difference equal to the error."""
    return combine(members(fine, coarse), ErrorBars(seeds=(1, 2), order=order))


def members(fine: list[float], coarse: list[float]) -> xr.Dataset:
    """The data set of one cell whose outcomes all have the same values."""
    values = xr.DataArray([coarse, fine], dims=("resolution", "seed"))
    state = xr.where(values.notnull(), "done", "pending").astype(object)
    numbers = {name: values.assign_attrs(variable.attributes()) for name, variable in OUTCOMES.items()}
    texts = {"state": state, "reason": xr.full_like(state, ""), "job": xr.full_like(state, "a")}
    coords = {"resolution": ["coarse", "fine"], "seed": range(len(fine))}
    return xr.Dataset({**numbers, **texts}, coords=coords)


def test_spread_and_resolution_add_in_quadrature() -> None:
    cell = cell_of([1.0, 2.0, 3.0], [4.0, 5.0, 6.0])
    assert cell["b_over_a"] == 2.0
    assert cell["b_over_a_error"] == pytest.approx(np.sqrt(1.0 / 3.0 + 9.0))
    assert cell["b_over_a_resolved"] == 0.0  # 3 against 2 t sqrt(1/3) sqrt(2) = 3.5
    assert cell_of([1.0, 2.0, 3.0], [6.0, 7.0, 8.0])["b_over_a_resolved"] == 1.0


@pytest.mark.parametrize("order", [0.5, 0.75, 2.0])
@pytest.mark.parametrize("coarser", [0.2, 0.5])
def test_the_error_is_that_of_the_finer_resolution_where_outcomes_converge_with_the_order(
    order: float, coarser: float
) -> None:
    exact, count = 1.5, 2000.0
    fine, coarse = (exact + 8.0 * number ** (-order / 3.0) for number in (count, coarser * count))
    bars = ErrorBars(coarser=coarser, seeds=(1, 2), order=order)
    cell = combine(members([fine, fine], [coarse, coarse]), bars)
    np.testing.assert_allclose(cell["b_over_a_error"], fine - exact, rtol=1e-9)


def test_the_default_order_is_three_quarters() -> None:
    bars = ErrorBars(seeds=(1, 2))
    assert bars.error_over_difference == pytest.approx(1.0 / (2.0**0.25 - 1.0)) == pytest.approx(5.285, abs=1e-3)
    comment = str(combine(members([1.0, 2.0], [3.0, 4.0]), bars)["b_over_a_error"].attrs["comment"])
    assert "5.29" in comment and "p = 0.75" in comment and "f = 0.5" in comment


def test_the_error_uses_the_order_of_the_study(tmp_path: Path) -> None:
    errors = [
        float(collect(campaign(tmp_path / str(order), bars=BARS | {"order": order}))["b_over_a_error"][0, 0])
        for order in (0.5, 2.0)
    ]
    assert errors[0] > 4.0 * errors[1] > 0.0


def test_error_bars_that_campaign_json_lacks_are_named(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"campaign\.json: error_bars: missing key 'seeds'"):
        collect(campaign(tmp_path, bars=None))


def test_costs_add_up_and_flags_are_shares() -> None:
    cell = cell_of([1.0, 0.0, 1.0], [0.0, 0.0, 0.0])
    assert cell["cpu_time"] == 2.0 and cell["steps"] == 2.0
    assert cell["settled"] == pytest.approx(2.0 / 3.0)
    assert not {"settled_error", "cpu_time_error"} & set(cell.data_vars)


NAN = float("nan")


@pytest.mark.parametrize(
    ("fine", "coarse", "value", "known"),
    [([1.0, 3.0], [NAN, 2.0], 2.0, True), ([1.0, NAN], [1.0, 2.0], 1.0, False), ([1.0, 3.0], [NAN, NAN], 2.0, False)],
)
def test_a_partial_cell_uses_what_is_there(fine: list[float], coarse: list[float], value: float, known: bool) -> None:
    cell = cell_of(fine, coarse)
    assert cell["b_over_a"] == value
    assert np.isfinite(cell["b_over_a_error"]) == known
    assert cell["members"] == np.isfinite([fine, coarse]).sum() and cell["state"] == "pending"


def test_without_the_finer_resolution_there_is_no_value() -> None:
    cell = cell_of([NAN, NAN], [1.0, 2.0])
    assert np.isnan(cell["b_over_a"]) and np.isnan(cell["b_over_a_error"])
    assert cell["cpu_time"] == 3.0 and cell["members"] == 2


def test_results_hold_cells_and_members_hold_runs(tmp_path: Path) -> None:
    results = collect(campaign(tmp_path))
    xr.testing.assert_equal(results, read_dataset(tmp_path / "results.nc"))
    runs = read_dataset(tmp_path / "members.nc")
    assert dict(runs.sizes) == {"velocity": 1, "angle": 2, "resolution": 2, "seed": 2}
    assert dict(results.sizes) == {"velocity": 1, "angle": 2}
    fine = runs["b_over_a"].sel(resolution="fine")
    np.testing.assert_array_equal(results["b_over_a"], fine.mean("seed"))
    assert results["b_over_a_error"].notnull().all() and (results["state"] == "done").all()
    assert results["members"].values.tolist() == [[4, 4]]
    assert (results["particles"] == 200).all()
    assert (
        results["b_over_a_error"].attrs["units"] == "1"
        and "standard error" in results["b_over_a_error"].attrs["comment"]
    )


@pytest.mark.parametrize("state", ["pending", "failed"])
def test_a_cell_is_done_only_when_all_members_are(tmp_path: Path, state: str) -> None:
    results = collect(campaign(tmp_path, missing=((15.0, "coarse", 2),), state=state)).isel(velocity=0)
    assert results["state"].values.tolist() == ["done", state]
    assert results["members"].values.tolist() == [4, 3]
    assert results["reason"].values.tolist() == ["", "too hot" if state == "failed" else ""]
    assert np.isfinite(results["b_over_a"]).all()


def test_the_table_shows_value_and_error(tmp_path: Path) -> None:
    results = collect(campaign(tmp_path, missing=((15.0, "coarse", 1), (15.0, "coarse", 2))))
    table = shape_table(results)
    assert {"b_over_a", "b_over_a_error"} <= set(table.columns)
    first, second = printed(table).splitlines()[1:]
    cell = results.isel(velocity=0, angle=0)
    assert f"{float(cell['b_over_a']):.2f} +- {float(cell['b_over_a_error']):.2f}" in first
    assert f"{float(results['b_over_a'][0, 1]):.2f} +- -" in second and "b/a_error" not in printed(table)


def test_what_seeds_do_not_resolve_is_said() -> None:
    alike, apart = (members([1.0, 2.0, 3.0], coarse).expand_dims(angle=[15.0]) for coarse in ([1, 2, 3.5], [6, 7, 8.0]))
    bars = ErrorBars(seeds=(1, 2))
    (line,) = unresolved(combine(alike, bars).assign_coords(velocity=200.0))
    assert line.startswith("angle 15: ") and "b/a" in line
    assert not unresolved(combine(apart, bars))


def test_figures_show_the_errors(tmp_path: Path) -> None:
    results, written = plots(campaign(tmp_path))
    assert len(written) == 6
    figure = shape_versus_angle.draw(results, {})
    bars = figure.axes[0].containers[0].lines[2][0].get_segments()
    lengths = [0.5 * (bar[1][1] - bar[0][1]) for bar in bars]
    np.testing.assert_allclose(lengths, results["b_over_a_error"].isel(velocity=0))
