"""Energies of one run and drifts of all."""

import numpy as np
from matplotlib.colors import to_rgba

from analysis.remnant.conservation import drifts, read_history
from analysis.report.figures import conservation
from engine.job.directory import JobState
from engine.scene.scene import scene_in

ENERGIES = {
    "kinetic": "kinetic_energy",
    "kinetic, affine part": "affine_kinetic_energy",
    "internal": "internal_energy",
    "of it heat of the transfer": "transfer_heat",
    "gravitational": "gravitational_energy",
    "total": "total_energy",
}


def test_the_ledger_shows_all_energies_of_the_first_run_in_units_of_its_kinetic_energy(partly_done) -> None:
    ledger = conservation.draw(partly_done.results, partly_done.outcomes).axes[0]
    history = read_history(partly_done.outcomes["0"].job.history)
    assert ledger.get_title() == "energies at 100 m/s, 5°"
    assert ledger.get_xlabel() == "time after contact [1000 s]"
    assert ledger.get_ylabel() == "energy / kinetic energy at the start"
    lines = {line.get_label(): line for line in ledger.lines if line.get_label() in ENERGIES}
    assert set(lines) == set(ENERGIES)
    for label, name in ENERGIES.items():
        np.testing.assert_allclose(lines[label].get_xdata(), history["time"] / 1000.0)
        np.testing.assert_allclose(lines[label].get_ydata(), history[name] / 5e21)


def test_every_run_has_its_line_of_each_drift_in_the_colour_of_its_velocity(partly_done) -> None:
    figure = conservation.draw(partly_done.results, partly_done.outcomes)
    panels = figure.axes[1:]
    done = [outcome.job for outcome in partly_done.outcomes.values() if outcome.state is JobState.DONE]
    assert [axes.get_title() for axes in panels] == ["mass", "momentum", "angular momentum", "total energy"]
    for axes, name in zip(panels, ("mass", "momentum", "angular_momentum", "total_energy"), strict=True):
        assert axes.get_yscale() == "log" and len(axes.lines) == 4
        for line, job in zip(axes.lines, done, strict=True):
            found = np.abs(drifts(read_history(job.history), scene_in(job.path))[name][1:])
            np.testing.assert_allclose(line.get_ydata(), np.maximum(found, 1e-17))
        colours = [to_rgba(line.get_color()) for line in axes.lines]
        assert colours[0] == colours[1] == colours[2] != colours[3], "three runs at 100 m/s, one at 200 m/s"


def test_axes_and_velocities_are_named(partly_done) -> None:
    figure = conservation.draw(partly_done.results, partly_done.outcomes)
    texts = [part.get_supxlabel() for part in figure.subfigs] + [part.get_supylabel() for part in figure.subfigs]
    assert {"time after contact [1000 s]", "size of the relative change since the start"} <= set(texts)
    legends = [[text.get_text() for text in legend.get_texts()] for part in figure.subfigs for legend in part.legends]
    assert legends == [list(ENERGIES), ["100 m/s", "200 m/s"]]


def test_without_results_the_figure_says_so(nothing_done) -> None:
    (axes,) = conservation.draw(nothing_done.results, {}).axes
    assert [text.get_text() for text in axes.texts] == ["no job of this campaign is done yet"]
