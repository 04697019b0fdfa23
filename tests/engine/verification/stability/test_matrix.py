"""The matrix in processes of its own ends as recorded."""

from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pytest
from typer.testing import CliRunner

from engine.cli import application
from engine.device.options import usable_cores
from engine.verification.stability import matrix
from engine.verification.stability.cases import all_cases
from engine.verification.stability.outcome import STABLE, failure
from tests.helpers.stability_cases import BY_NAME, recorded


def test_a_process_that_dies_is_a_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def dies(*given):
        raise BrokenProcessPool

    monkeypatch.setattr(matrix, "in_own_process", dies)
    # in words: unknown measures are not equal to themselves
    assert repr(matrix.run_apart(tmp_path, 0)) == repr(failure(all_cases()[0], "its process died"))


def test_a_case_in_single_precision_is_run_in_it(tmp_path: Path) -> None:
    outcome = matrix.run_apart(tmp_path, list(BY_NAME).index(("f32", "E = 1e+08 J/kg")))
    assert (outcome.verdict, outcome.precision) == (STABLE, "f32"), outcome.reason
    # round-off of f32, far above that of f64
    assert 1e-12 < outcome.measures.momentum_drift < outcome.measures.momentum_bound < 1e-4


def test_a_directory_that_exists_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for work in ("run_all", "find_limits"):
        monkeypatch.setattr(matrix, work, lambda *given: iter(()))
    result = CliRunner().invoke(application, ["stability", str(tmp_path)])
    assert result.exit_code == 2 and "exists already; name a new directory" in result.output
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_whole_matrix_ends_as_recorded(tmp_path: Path) -> None:
    outcomes = list(matrix.run_all(tmp_path, usable_cores()))
    assert [(o.group, o.name) for o in outcomes if not o.acceptable] == []
    assert [o.verdict for o in outcomes] == recorded()["verdict"].tolist()
