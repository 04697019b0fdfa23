"""Outcomes over velocity and angle."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.report.figures import maps
from analysis.results.collect import collect
from tests.helpers.fake_campaigns import campaign, grid

NAMES = ("mass_ratio", "b_over_a", "c_over_a")


def texts(axes: Any) -> dict[tuple[float, float], str]:
    """What stands in each cell, by its column and row."""
    return {text.get_position(): text.get_text() for text in axes.texts}


def test_each_map_shows_one_outcome_by_velocity_and_angle(partly_done) -> None:
    figure = maps.draw(partly_done.results, {})
    titles = [axes.get_title() for axes in figure.axes]
    assert titles == [r"$M_\mathrm{lr}\,/\,M_\mathrm{target}$", "$b/a$", "$c/a$"]
    assert figure.axes[0].get_ylabel() == "velocity at contact [m/s]"
    for axes, name in zip(figure.axes, NAMES, strict=True):
        assert axes.get_xlabel() == "impact angle [deg]"
        assert [label.get_text() for label in axes.get_xticklabels()] == ["5", "15", "25"]
        assert [label.get_text() for label in axes.get_yticklabels()] == ["100", "200"]
        (image,) = axes.images
        assert image.origin == "lower", "the first velocity is at the bottom, where its label is"
        expected = partly_done.results[name].transpose("velocity", "angle").values
        np.testing.assert_allclose(np.ma.filled(image.get_array(), np.nan), expected)


def test_colours_mean_the_same_in_every_campaign(partly_done) -> None:
    """Mass over that of one of two equal bodies ends at 2, ratios of axes at 1."""
    limits = [axes.images[0].get_clim() for axes in maps.draw(partly_done.results, {}).axes]
    assert limits == [(0.0, 2.0), (0.0, 1.0), (0.0, 1.0)]


@pytest.mark.parametrize("number", range(3), ids=NAMES)
def test_cells_carry_their_number_or_the_state_of_their_job(partly_done, number: int) -> None:
    axes, values = maps.draw(partly_done.results, {}).axes[number], partly_done.results[NAMES[number]]
    assert len(axes.texts) == 6
    for (column, row), text in texts(axes).items():
        value = float(values.sel(velocity=(100.0, 200.0)[int(row)], angle=(5.0, 15.0, 25.0)[int(column)]))
        assert text == ("pending" if np.isnan(value) else f"{value:.2f}")
    assert len(axes.patches) == 2, "hatched where there is no number"


def test_a_series_has_its_row_of_maps_and_seeds_their_mean(tmp_path: Path) -> None:
    coords = {"velocity": [200.0], "angle": [5.0, 15.0], "seed": [1, 2], "materials.basalt.friction": [0.4, 0.8]}
    results = collect(campaign(tmp_path, coords, grid(coords), 8))
    panels = np.reshape(maps.draw(results, {}).axes, (2, 3))
    titles = [axes.get_ylabel().splitlines()[0] for axes in panels[:, 0]]
    assert titles == ["friction 0.4", "friction 0.8"]
    for row, friction in zip(panels, (0.4, 0.8), strict=True):
        mean = results["b_over_a"].sel({"materials.basalt.friction": friction}).mean("seed")
        np.testing.assert_allclose(row[1].images[0].get_array(), mean.transpose("velocity", "angle"))


def test_without_results_every_cell_is_pending(nothing_done) -> None:
    for axes in maps.draw(nothing_done.results, {}).axes:
        assert list(texts(axes).values()) == ["pending"] * 6
