"""Runs of verification scenes with one setting varied."""

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from engine.scene.scene import Scene, Sphere
from engine.verification.accuracy import figure, sweep
from engine.verification.accuracy.settings import TRADEOFFS, Tradeoff
from engine.verification.accuracy.sweep import Trial, measure, orders, read, write
from engine.verification.harness import Harness, Setting, altered
from engine.verification.problems.column import StandingWave

RECORDED = Path(figure.__file__).with_name("work_precision.nc")


def known(cells: tuple[int, ...], settings: dict[str, tuple[Setting, ...]]) -> Tradeoff:
    """A scene whose error is its number of cells and its Courant number."""

    def error(harness: Harness, resolution: int) -> float:
        simulation = harness.start(StandingWave(resolution).scene)
        harness.run_until(simulation, 1e-4)
        return 1000.0 * resolution + simulation.scene.numerics.cfl

    return Tradeoff("error", error, "cells", cells, settings)


def test_no_run_is_done_twice_and_a_scene_accepts_every_value():
    scene = Scene(bodies=(Sphere(radius=50e3, particles=10),), end_time=1.0)
    for tradeoff in TRADEOFFS.values():
        assert len(set(tradeoff.runs)) == len(tradeoff.runs)
        for setting, values in tradeoff.settings.items():
            for value in values:
                changed = altered(scene, setting, value)
                assert Scene.model_validate(changed.model_dump()) == changed


def test_each_run_varies_one_setting_at_the_first_resolution(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(TRADEOFFS, "known", known((16, 8), {"numerics.cfl": (0.25,)}))
    assert TRADEOFFS["known"].runs == [("cells", 16), ("cells", 8), ("numerics.cfl", 0.25)]
    runs = [measure("known", *run) for run in TRADEOFFS["known"].runs]
    assert [run.error for run in runs] == [16000.6, 8000.6, 16000.25]
    assert [run.value for run in runs] == ["16", "8", "0.25"] and all(run.cpu_time > 0.0 for run in runs)


def test_runs_that_a_file_contains_are_not_repeated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(TRADEOFFS, "known", known((16, 8), {}))
    monkeypatch.setattr(
        sweep, "in_own_process", lambda precision, function, *run: Trial(*run[:2], str(run[2]), 1.0, 2.0)
    )
    path = tmp_path / "scenes.nc"
    write(path, pd.DataFrame([asdict(Trial("known", "cells", "16", 3.0, 4.0))]))
    assert [run.value for run in sweep.sweep(["known"], path, 1)] == ["8"]
    assert read(path)["error"].tolist() == [3.0, 1.0]


def test_orders_are_those_of_the_data():
    """And none of round-off."""
    wave = [Trial("wave", "cells", str(n), 5.0 / n**2, 1.0) for n in (8, 16, 32)]
    steps = [Trial("wave", "numerics.cfl", str(cfl), 3.0 * cfl, 1.0) for cfl in (0.1, 0.5)]
    ball = [Trial("ball", "particles", str(n), n ** (-1.0 / 3.0), 1.0) for n in (100, 1000)]
    other = [Trial("wave", "numerics.precision", name, 1.0, 1.0) for name in ("f64", "f32")]
    exact = [Trial("exact", "cells", str(n), error, 1.0) for n, error in ((8, 0.0), (16, 1e-15))]
    table = orders(pd.DataFrame([asdict(run) for run in wave + steps + ball + other + exact]))
    assert list(zip(table["scene"], table["setting"], strict=True)) == [
        ("wave", "cells"),
        ("wave", "numerics.cfl"),
        ("ball", "particles"),
    ]
    np.testing.assert_allclose(table["order in dx or dt"], [2.0, 1.0, 1.0])


def test_the_page_s_data_are_the_runs_of_these_settings():
    runs = read(RECORDED)
    wanted = {(scene, setting, str(value)) for scene, tradeoff in TRADEOFFS.items() for setting, value in tradeoff.runs}
    assert set(runs[sweep.KEYS].itertuples(index=False, name=None)) == wanted
