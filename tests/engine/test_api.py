"""The Python interface gives the states of a job, and importing the package starts nothing."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import engine
from engine.errors import SceneError
from engine.job.session import Options, run_job
from engine.job.storage import read_dataset
from engine.scene.scene import Scene
from tests.helpers.scenes import rubble_collision


def collision() -> Scene:
    """It pauses for its history at its end."""
    return rubble_collision(output={"history_interval": 40.0}).model_copy(update={"end_time": 40.0})


def test_a_scene_opened_in_python_ends_in_the_state_of_its_job(tmp_path: Path) -> None:
    (tmp_path / "scene.json").write_text(collision().canonical())
    assert run_job(tmp_path, Options()).state == "done"
    simulation = engine.open_scene(tmp_path, threads=1)
    assert simulation.time == collision().start_time
    for until in (15.0, None):
        simulation.advance(until)
    final, particles = read_dataset(tmp_path / "final.nc"), simulation.particles()
    assert set(particles.variables) == set(final.variables)
    for name in particles.data_vars:
        np.testing.assert_array_equal(particles[name], final[name], err_msg=str(name))
    assert particles.attrs["time"] == final.attrs["time"] >= 40.0


def test_advance_stops_at_the_first_step_that_reaches_the_time() -> None:
    simulation = engine.open_scene(collision(), threads=1)
    simulation.advance(15.0)
    assert 15.0 <= simulation.time < 15.0 + 2.0 * simulation.simulation.next_dt
    simulation.advance(10.0)
    assert simulation.time < 40.0


def test_a_file_that_is_no_scene_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"scene\.toml"):
        engine.open_scene(tmp_path)


def test_importing_the_package_does_not_import_taichi() -> None:
    program = "import sys, engine; engine.Scene, engine.open_scene; sys.exit('taichi' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_an_unknown_name_is_no_attribute() -> None:
    with pytest.raises(AttributeError, match="open_scne"):
        _ = engine.open_scne
