"""Pictures of the largest remnants."""

import re
from typing import Any

import numpy as np
import pytest

from analysis.report.figures import gallery


def panels(figure: Any) -> list[Any]:
    """The panels of cells, first row first."""
    return [axes for axes in figure.axes if axes.get_title()]


def test_every_cell_has_its_panel_with_its_outcome_in_words(partly_done) -> None:
    results = partly_done.results
    found = [axes.get_title().splitlines() for axes in panels(gallery.draw(results, partly_done.outcomes))]
    cells = [(velocity, angle) for velocity in (100.0, 200.0) for angle in (5.0, 15.0, 25.0)]
    assert [lines[0] for lines in found] == [f"{velocity:g} m/s, {angle:g}°" for velocity, angle in cells]
    for lines, (velocity, angle) in zip(found, cells, strict=True):
        cell = results.sel(velocity=velocity, angle=angle)
        numbers = [float(number) for line in lines[1:] for number in re.findall(r"\d+\.\d+", line)]
        expected = [float(cell[name]) for name in ("mass_ratio", "b_over_a", "c_over_a")]
        assert numbers == ([] if np.isnan(expected[0]) else [round(value, 2) for value in expected])


def test_a_done_cell_shows_two_views_and_another_one_the_state_of_its_job(partly_done) -> None:
    found = panels(gallery.draw(partly_done.results, partly_done.outcomes))
    assert [len(axes.images) for axes in found] == [2, 2, 2, 2, 0, 0]
    assert [text.get_text() for axes in found[4:] for text in axes.texts] == ["pending"] * 2


def test_all_remnants_are_at_one_scale_which_the_bar_tells(partly_done) -> None:
    """Job 0 is a lattice of 100 km, and each further one 40 km longer."""
    figure = gallery.draw(partly_done.results, partly_done.outcomes)
    found = panels(figure)[:4]
    (limits,) = {axes.get_xlim() for axes in found}
    width = limits[1] - limits[0]
    lengths = [np.ptp(axes.images[0].get_extent()[:2]) for axes in found]
    np.testing.assert_allclose(np.diff(lengths), 4e4, atol=1.5e4)
    assert max(lengths) <= width
    (note,) = [text.get_text() for axes in figure.axes for text in axes.texts if " km" in text.get_text()]
    (bar,) = [line for axes in figure.axes for line in axes.lines]
    assert float(note.split(" km")[0]) * 1e3 == pytest.approx(np.ptp(bar.get_xdata()) * width)


def test_seen_along_the_shortest_axis_and_below_edge_on(partly_done) -> None:
    for axes in panels(gallery.draw(partly_done.results, partly_done.outcomes))[:4]:
        flat, edge = (image.get_extent() for image in axes.images)
        assert np.ptp(flat[:2]) == np.ptp(edge[:2]), "the longest axis lies along both"
        assert np.ptp(flat[2:]) > np.ptp(edge[2:]) and flat[2] >= edge[3], "the wider view is above"


def test_without_results_the_figure_says_so(nothing_done) -> None:
    (axes,) = gallery.draw(nothing_done.results, {}).axes
    assert [text.get_text() for text in axes.texts] == ["no job of this campaign is done yet"]
