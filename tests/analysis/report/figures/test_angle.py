"""Axis ratios against impact angle."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import same_color

from analysis.report.figures import angle
from analysis.results.collect import collect
from tests.helpers.fake_campaigns import campaign, collision, grid
from tests.helpers.fake_jobs import lattice_ellipsoid, particles, write_campaign, write_job


def curves(axes: Any) -> list[Any]:
    """The lines through the means, without the bars on them and the hollow points over them."""
    return [container.lines[0] for container in axes.containers]


def finite(results: xr.Dataset, name: str, velocity: float) -> np.ndarray:
    """Angle and value of the cells that have one, shape [cells, 2]."""
    values = results[name].sel(velocity=velocity).dropna("angle")
    return np.stack([values["angle"], values], axis=1)


def test_a_panel_for_each_axis_ratio_has_a_line_for_each_velocity_through_the_results(partly_done) -> None:
    figure = angle.draw(partly_done.results, {})
    assert [axes.get_title() for axes in figure.axes] == ["$b/a$", "$c/a$"]
    assert [axes.get_xlabel() for axes in figure.axes] == ["impact angle [deg]"] * 2
    assert figure.axes[0].get_ylabel() == "axis ratio of the largest remnant"
    for axes, name in zip(figure.axes, ("b_over_a", "c_over_a"), strict=True):
        assert axes.get_ylim()[0] == 0.0 and axes.get_ylim()[1] >= 1.0, "all that a ratio can be"
        for line, velocity in zip(curves(axes), (100.0, 200.0), strict=True):
            points = np.asarray(line.get_xydata())
            np.testing.assert_allclose(points[np.isfinite(points[:, 1])], finite(partly_done.results, name, velocity))
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels[:2] == ["100 m/s", "200 m/s"] and labels[2].startswith("thin")


def test_bars_are_the_standard_deviation_over_seeds(tmp_path: Path) -> None:
    coords = {"velocity": [200.0], "angle": [5.0, 15.0], "seed": [1, 2, 3]}
    results = collect(campaign(tmp_path, coords, grid(coords), 6))
    axes = angle.draw(results, {}).axes[0]
    (container,) = axes.containers
    (bars,) = container.lines[2]
    half = [0.5 * (segment[1, 1] - segment[0, 1]) for segment in bars.get_segments()]
    spread = results["b_over_a"].sel(velocity=200.0).std("seed", ddof=1)
    np.testing.assert_allclose(half, spread)
    assert (spread > 0.0).all()


def test_only_thin_remnants_are_hollow(tmp_path: Path) -> None:
    jobs = [({"velocity": 200.0, "angle": a}, collision(angle=a)) for a in (5.0, 15.0)]
    write_campaign(tmp_path, {"velocity": [200.0], "angle": [5.0, 15.0]}, jobs)
    for number, c in enumerate((8e4, 1.5e4)):
        points, spacing = lattice_ellipsoid((2e5, 1e5, c), 150)
        write_job(tmp_path / f"jobs/{number}", jobs[number][1], particles(points, spacing, time=900.0))
    results = collect(tmp_path)
    assert results["c_unresolved"].values.tolist() == [[0.0, 1.0]]
    for axes in angle.draw(results, {}).axes:
        hollow = [line for line in axes.lines if same_color(line.get_markerfacecolor(), "white")]
        assert [line.get_xdata().tolist() for line in hollow] == [[15.0]]
        (line,) = curves(axes)
        assert same_color(line.get_markerfacecolor(), line.get_color())


@pytest.mark.parametrize("velocities", [[200.0], [100.0, 200.0]])
def test_no_two_lines_look_alike(tmp_path: Path, velocities: list[float]) -> None:
    coords = {"velocity": velocities, "angle": [5.0], "materials.basalt.friction": [0.4, 0.5, 0.6, 0.8]}
    results = collect(campaign(tmp_path, coords, grid(coords), 4 * len(velocities)))
    lines = angle.draw(results, {}).legends[0].get_lines()[:-1]
    looks = {(tuple(line.get_color()), line.get_marker(), line.get_linestyle()) for line in lines}
    assert len(lines) == len(looks) == 4 * len(velocities)
    assert len({look[0] for look in looks}) == (4 if len(velocities) == 1 else 2)


def test_without_results_the_figure_says_so(nothing_done) -> None:
    (axes,) = angle.draw(nothing_done.results, {}).axes
    assert [text.get_text() for text in axes.texts] == ["no job of this campaign is done yet"]
