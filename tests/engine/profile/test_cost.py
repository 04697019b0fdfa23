"""Time of steps: what is counted, and what is left alone."""

import time
from pathlib import Path

import pytest

from engine.errors import SceneError
from engine.profile.cost import Cost, measure
from tests.helpers.scenes import body, scene

FLYING = scene(body(velocity=(100.0, 0.0, 0.0)))


def test_laps_add_wall_and_cpu_time(taichi: None) -> None:
    cost = Cost()
    for _ in range(2):
        with cost.lap():
            time.sleep(0.02)
    assert cost.calls == 2 and cost.wall > 0.04 > cost.cpu


def test_kernels_are_timed_within_the_steps_that_are_measured(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text(FLYING.canonical())
    result = measure(path, 6, "cpu", 1)
    assert result.steps == 6 and result.simulation.step == 7 and result.begun > 0.0
    stages = {part: cost for (part, _), cost in result.kernels.items() if cost.calls}
    calls = {part: cost.calls for part, cost in stages.items()}
    assert calls == {"transfer": 6, "kick": 6, "drift": 12, "projection": 6, "correction": 6}
    assert 0.0 < sum(cost.wall for cost in result.kernels.values()) < result.whole.wall
    assert [file.name for file in tmp_path.iterdir()] == ["scene.json"]


def test_no_more_steps_are_measured_than_the_scene_has(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_text(FLYING.model_copy(update={"end_time": 10.0}).canonical())
    result = measure(path, 1000, "cpu", 1)
    assert result.simulation.finished and result.steps == result.simulation.step - 1 < 1000


def test_a_missing_scene_is_named(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="absent"):
        measure(tmp_path / "absent.toml", 1, "cpu", 1)
