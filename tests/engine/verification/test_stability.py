"""Stiff and extreme cases: verdicts mean what they say, and the matrix ends as recorded."""

import os
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import same_color
from matplotlib.figure import Figure
from typer.testing import CliRunner

import engine.simulation.guard
from engine.cli import application
from engine.device.options import chosen
from engine.job.directory import JobDirectory
from engine.job.storage import read_dataset
from engine.verification.processes import in_own_process
from engine.verification.stability import heat_map, matrix
from engine.verification.stability.case import Case, alone, uniform
from engine.verification.stability.cases import FREE, all_cases
from engine.verification.stability.measures import LARGEST_GROWTH, Measures
from engine.verification.stability.outcome import FAILED, STABLE, STOPPED, Outcome, failure, run_case
from engine.verification.stability.results import dataset, summary, write
from engine.verification.stability.von_neumann import BLOCKS, Block, Limit

CASES = all_cases()
BY_NAME = {(case.group, case.name): case for case in CASES}
RECORDED = Path(heat_map.__file__).with_name("stability.csv")

FAST = [
    ("speed", "20000 m/s"),
    ("mass ratio", "1:1000 at 5000 m/s"),
    ("compressed", "rho/rho0 = 2"),
    ("particles", "1"),
    ("place", "two in one point"),
]
TOO_FAR = ("place", "leaves the grid's range")
TOO_LONG = ("Courant number", "5")

CALM = Measures(0.0, 1e-16, 1e-14, 0.01, 0.1, 200.0, 2000.0, 1.2, 3.0)


def test_there_are_many_cases_and_each_has_a_name_of_its_own() -> None:
    assert len(CASES) >= 60
    assert len(BY_NAME) == len(CASES)


def recorded() -> pd.DataFrame:
    return pd.read_csv(RECORDED, dtype={"name": str}, keep_default_na=False).set_index(["group", "name"])


def test_the_committed_table_is_fresh_of_exactly_the_cases_in_the_code_and_none_of_them_failed() -> None:
    """A check of the file, not of the engine: whoever adds, renames or removes a case must run the matrix anew.

    That its verdicts are those of the engine, `FAST` cases test here and all cases in the slow tests.
    """
    table = recorded()
    assert list(table.index) == list(BY_NAME)
    assert set(table["verdict"]) == {STABLE, STOPPED}
    assert (table["verdict"][table["physical"] == 1] == STABLE).all()
    assert list(table["physical"]) == [int(case.physical) for case in CASES]


@pytest.mark.parametrize("key", FAST, ids=": ".join)
def test_extreme_cases_are_stable(tmp_path: Path, key: tuple[str, str]) -> None:
    outcome = run_case(BY_NAME[key], tmp_path)
    assert outcome.verdict == STABLE == recorded().loc[key, "verdict"], outcome.reason
    assert outcome.progress == 1.0 and outcome.measures.mass_change == 0.0


@pytest.mark.parametrize(
    ("key", "quantity"), [(TOO_FAR, "coordinate [m] of particle 1"), (TOO_LONG, "growth of total energy")]
)
def test_what_must_stop_says_why_and_keeps_its_checkpoint(tmp_path: Path, key: tuple[str, str], quantity: str) -> None:
    outcome = run_case(BY_NAME[key], tmp_path)
    assert outcome.verdict == STOPPED == recorded().loc[key, "verdict"]
    assert outcome.reason.startswith(quantity) and outcome.acceptable
    assert not replace(outcome, physical=True).acceptable
    job = JobDirectory(tmp_path)
    assert job.status().reason == outcome.reason and not job.final.exists()
    assert read_dataset(job.checkpoint).sizes["particle"] == BY_NAME[key].scene.particles


def test_an_exception_is_a_failure(tmp_path: Path) -> None:
    def broken(scene):
        raise ZeroDivisionError("by nothing")

    outcome = run_case(Case("any", "any", alone(), broken), tmp_path)
    assert (outcome.verdict, outcome.reason) == (FAILED, "ZeroDivisionError: by nothing")
    assert not outcome.acceptable


def test_a_start_that_a_checkpoint_cannot_hold_is_a_failure_and_not_replaced_by_the_scenes_own(tmp_path: Path) -> None:
    outcome = run_case(Case("any", "any", alone(100.0, physics=FREE), uniform(E=np.nan)), tmp_path)
    assert outcome.verdict == FAILED and "E of particle 0 is not finite" in outcome.reason


def test_a_stop_without_a_good_checkpoint_is_a_failure(tmp_path: Path) -> None:
    def one_fast(scene):
        velocity = np.zeros((scene.particles, 3))
        velocity[7] = [3e5, 0.0, 0.0]
        return {"v": velocity}

    outcome = run_case(Case("any", "any", alone(particles=200, physics=FREE), one_fast, physical=False), tmp_path)
    assert outcome.verdict == FAILED
    assert outcome.reason.startswith("speed [m/s] of particle") and "no checkpoint to go on from" in outcome.reason


def test_growth_that_no_guard_notices_is_a_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine.simulation.guard, "ENERGY_GROWTH", np.inf)
    case = BY_NAME[TOO_LONG]
    outcome = run_case(replace(case, scene=case.scene.model_copy(update={"end_time": -20.0})), tmp_path)
    assert outcome.verdict == FAILED and outcome.measures.energy_growth > LARGEST_GROWTH
    assert outcome.reason.startswith("energy at") and outcome.reason.endswith("of its bound, and no guard noticed")


def test_what_is_within_all_bounds_breaks_none() -> None:
    assert CALM.broken() == ""
    assert CALM.nearest == pytest.approx(0.5)
    unknown = Measures(0.0, 0.0, 1e-14, np.nan, np.nan, 0.0, 1.0, 1.0, np.inf)
    assert unknown.broken() == "" and unknown.nearest == 0.0


@pytest.mark.parametrize(
    ("bound", "change"),
    [
        ("mass", {"mass_change": 1e-16}),
        ("momentum", {"momentum_drift": 1.01e-14}),
        ("energy", {"energy_growth": 1.01 * LARGEST_GROWTH}),
        ("speed", {"speed": 2001.0}),
        ("rho/rho0", {"compression": 3.01}),
    ],
)
def test_each_bound_can_be_broken(bound: str, change: dict[str, float]) -> None:
    found = replace(CALM, **change)
    assert found.broken().startswith(f"{bound} at ") and found.nearest > 1.0


def test_a_process_that_dies_is_a_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(BrokenProcessPool):
        in_own_process("f64", os.abort)

    def dies(*given):
        raise BrokenProcessPool

    monkeypatch.setattr(matrix, "in_own_process", dies)
    # in words: unknown measures are not equal to themselves
    assert repr(matrix.run_apart(tmp_path, 0)) == repr(failure(CASES[0], "its process died"))


def test_a_case_in_single_precision_is_run_in_it(tmp_path: Path) -> None:
    assert in_own_process("f32", chosen) == "f32" and chosen() == "f64"
    outcome = matrix.run_apart(tmp_path, list(BY_NAME).index(("f32", "E = 1e+08 J/kg")))
    assert (outcome.verdict, outcome.precision) == (STABLE, "f32"), outcome.reason
    # round-off of f32, far above that of f64
    assert 1e-12 < outcome.measures.momentum_drift < outcome.measures.momentum_bound < 1e-4


def test_limits_of_the_time_step_have_closed_forms_for_one_particle_a_cell_and_for_many() -> None:
    # one particle in the middle of a cell: at the shortest wave K = 4 c^2/dx^2 and T = 1
    assert Block((4, 4, 4)).theory() == pytest.approx(1.0, abs=2e-3)
    # without end of them: K = 68/35 c^2/dx^2 and T = 13/21
    assert Block((12, 12, 12)).theory() == pytest.approx(np.sqrt(5.0 / 3.0), abs=5e-3)


@pytest.mark.usefixtures("taichi")
def test_the_engine_has_the_limit_of_theory() -> None:
    block = BLOCKS[0]
    limit = block.theory()
    assert block.decays(0.98 * limit) and not block.decays(1.02 * limit)


def test_results_are_written_with_units_and_counted_by_group(tmp_path: Path) -> None:
    ends = [("a", "1", STABLE), ("a", "2", STOPPED), ("b", "1", FAILED)]
    outcomes = [Outcome(group, name, "f64", False, verdict, "", 5, 1.0, 0.1, CALM) for group, name, verdict in ends]
    results = dataset(outcomes, [Limit("1 x 1 x 1", 1.001, 1.0)])
    write(tmp_path, results)
    assert read_dataset(tmp_path / "stability.nc").identical(results)
    assert (tmp_path / "stability.png").is_file()
    assert all(set(results[name].attrs) == {"long_name", "units"} for name in results.data_vars)
    table = pd.read_csv(tmp_path / "stability.csv")
    assert list(table["verdict"]) == [STABLE, STOPPED, FAILED] and (table["nearest"] == 0.5).all()
    counts = summary(results)[[STABLE, STOPPED, FAILED]]
    assert counts.loc["a"].tolist() == [1, 1, 0] and counts.loc["b"].tolist() == [0, 0, 1]


def test_the_figure_has_a_row_for_each_group_and_a_cell_for_each_case_coloured_by_its_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cases = pd.DataFrame(
        [("a", "1", STABLE, 0.9), ("a", "2", STABLE, 0.1), ("b", "3", STOPPED, 0.5), ("b", "4", FAILED, np.nan)],
        columns=["group", "name", "verdict", "dissipation"],
    )
    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *given, **options: drawn.append(figure))
    heat_map.draw(cases, tmp_path / "stability.png")
    axes, scale = drawn[0].axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["a", "b"]
    assert axes.get_ylim() == (2.0, 0.0), "the first group is at the top"
    assert {text.get_text(): text.get_position() for text in axes.texts} == {
        "1": (0.5, 0.5),
        "2": (1.5, 0.5),
        "3": (0.5, 1.5),
        "4": (1.5, 1.5),
    }
    much, little, stopped, failed = (patch.get_facecolor() for patch in axes.patches)
    assert sum(much[:3]) < sum(little[:3]), "the more energy is lost, the darker"
    assert same_color(stopped, heat_map.COLORS[STOPPED]) and same_color(failed, heat_map.COLORS[FAILED])
    assert "energy lost" in scale.get_ylabel() and scale.get_ylim() == (0.0, 1.0)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == list(heat_map.COLORS)


def test_a_directory_that_exists_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for work in ("run_all", "find_limits"):
        monkeypatch.setattr(matrix, work, lambda *given: iter(()))
    result = CliRunner().invoke(application, ["stability", str(tmp_path)])
    assert result.exit_code == 2 and "exists already; name a new directory" in result.output
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_whole_matrix_ends_as_recorded(tmp_path: Path) -> None:
    outcomes = list(matrix.run_all(tmp_path, os.cpu_count() or 1))
    assert [(o.group, o.name) for o in outcomes if not o.acceptable] == []
    assert [o.verdict for o in outcomes] == recorded()["verdict"].tolist()
