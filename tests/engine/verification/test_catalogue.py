"""Scenes with known answers are solved."""

import pytest
from typer.testing import CliRunner

from engine.cli import application
from engine.verification.catalogue import FULL, SHORT
from engine.verification.check import Problem
from engine.verification.harness import Harness
from engine.verification.problems.bar import Bar
from engine.verification.problems.column import Column
from engine.verification.problems.expansion import Expansion
from engine.verification.problems.hugoniot import MURNAGHAN, Hugoniot
from engine.verification.problems.hydrostatic import Hydrostatic
from engine.verification.problems.rotation import Rotation
from engine.verification.problems.rubble import Rubble

FAST = [
    Hydrostatic(),
    Rotation(particles=300),
    Expansion(particles=300),
    Column(cells=(16, 32)),
    Hugoniot(speeds=(500.0,)),
    Hugoniot(speeds=(500.0,), cells=40, material=MURNAGHAN, name="hugoniot_murnaghan"),
    Bar(rates=(0.1, 1.0)),
    Rubble(particles=100, end_time=400.0),
]


def assert_solved(problem: Problem) -> None:
    assert not [check for check in problem.checks(Harness()) if not check.passed]


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("problem", FAST, ids=lambda problem: problem.name)
def test_small_problems_are_solved(problem):
    assert_solved(problem)


@pytest.mark.slow
@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("name", list(SHORT))
def test_problems_are_solved(name):
    assert_solved(SHORT[name])


@pytest.mark.slow
@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("name", [name for name in FULL if FULL[name] != SHORT.get(name)])
def test_fine_problems_are_solved(name):
    assert_solved(FULL[name])


def test_each_problem_stands_under_its_own_name():
    assert all(problem.name == name for table in (SHORT, FULL) for name, problem in table.items())


def test_an_unknown_problem_is_refused_with_the_nearest_name():
    result = CliRunner().invoke(application, ["verify", "slop"])
    assert result.exit_code == 2
    assert "did you mean 'slope'" in result.output
