"""Verdicts on stiff and extreme cases mean what they say."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import engine.simulation.guard
from engine.job.directory import JobDirectory
from engine.job.storage import read_dataset
from engine.verification.stability.case import ExtremeCase, alone
from engine.verification.stability.cases import FREE
from engine.verification.stability.measures import LARGEST_GROWTH
from engine.verification.stability.outcome import FAILED, STABLE, STOPPED, run_case
from tests.helpers.stability_cases import BY_NAME, TOO_FAR, TOO_LONG, recorded

FAST = [
    ("speed", "20000 m/s"),
    ("mass ratio", "1:1000 at 5000 m/s"),
    ("compressed", "rho/rho0 = 2"),
    ("particles", "1"),
    ("position", "two in one point"),
]


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

    outcome = run_case(ExtremeCase("any", "any", alone(), broken), tmp_path)
    assert (outcome.verdict, outcome.reason) == (FAILED, "ZeroDivisionError: by nothing")
    assert not outcome.acceptable


def test_a_start_that_a_checkpoint_cannot_hold_is_a_failure_and_not_replaced_by_the_scenes_own(tmp_path: Path) -> None:
    def undefined(scene):
        return {"E": np.full(scene.particles, np.nan)}

    outcome = run_case(ExtremeCase("any", "any", alone(100.0, physics=FREE), undefined), tmp_path)
    assert outcome.verdict == FAILED and "E of particle 0 is not finite" in outcome.reason


def test_a_stop_without_a_good_checkpoint_is_a_failure(tmp_path: Path) -> None:
    def one_fast(scene):
        velocity = np.zeros((scene.particles, 3))
        velocity[7] = [3e5, 0.0, 0.0]
        return {"v": velocity}

    outcome = run_case(
        ExtremeCase("any", "any", alone(particles=200, physics=FREE), one_fast, physical=False), tmp_path
    )
    assert outcome.verdict == FAILED
    assert outcome.reason.startswith("speed [m/s] of particle") and "no checkpoint to go on from" in outcome.reason


def test_growth_that_no_guard_notices_is_a_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine.simulation.guard, "largest_energy_change", lambda scene: np.inf)
    case = BY_NAME[TOO_LONG]
    outcome = run_case(replace(case, scene=case.scene.model_copy(update={"end_time": 60.0})), tmp_path)
    assert outcome.verdict == FAILED and outcome.measures.energy_growth > LARGEST_GROWTH
    assert outcome.reason.startswith("energy at") and outcome.reason.endswith("of its bound, and no guard noticed")
