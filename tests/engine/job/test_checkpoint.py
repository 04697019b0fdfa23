"""Checkpoints: a simulation goes on from one as if it had never stopped."""

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from engine import PHYSICS_VERSION
from engine.device import backend
from engine.errors import JobError
from engine.job.checkpoint import load_checkpoint, refuse_foreign, save_checkpoint
from engine.job.directory import JobDirectory
from engine.job.session import Options, run_job
from engine.job.storage import read_dataset, write_dataset
from engine.scene.material import named
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from tests.helpers.scenes import advance, body, scene, started

BARE: dict[str, Any] = {"energy": False, "shear": False, "strength": False, "fracture": None, "gravity": None}


def pair(**physics: Any) -> Scene:
    """Two intact bodies in contact."""
    one = body(damage=0.0)
    return scene(one, {**one, "position": (90e3, 0.0, 0.0)}, physics=physics)


def assert_same_state(one: Simulation, other: Simulation) -> None:
    assert one.clock_state() == other.clock_state()
    for name, values in one.particles.read().items():
        np.testing.assert_array_equal(other.particles.read(name)[name], values, err_msg=name)


@pytest.mark.usefixtures("taichi")
def test_clock_events_and_particles_are_restored(tmp_path: Path) -> None:
    given, job = pair(**{**BARE, "gravity": {"interval": 30.0, "opening": 0.0}}), JobDirectory(tmp_path)
    first = started(given)
    first.advance(given.end_time, steps=5)
    assert first.time < first.events.gravity_due < np.inf and first.events.gravity_change > 0.0
    save_checkpoint(job, first, {"history_due": 400.0, "snapshot_due": np.inf})
    second = Simulation(given)
    assert load_checkpoint(job, second) == {"history_due": 400.0, "snapshot_due": np.inf}
    assert_same_state(first, second)
    for each in (first, second):
        for _ in range(6):
            each.advance(given.end_time, steps=10)
    assert first.time > 2.0 * 30.0 + given.start_time
    assert_same_state(first, second)


@pytest.mark.usefixtures("taichi")
def test_rubble_that_loosens_resumes_to_the_same_bits(tmp_path: Path) -> None:
    loosening = named("basalt", friction=0.945, critical_density=2000.0, dilatancy=0.2, crushing_pressure=1e7)
    one = body(material=loosening, velocity=(0.0, 200.0, 0.0))
    given = scene(one, {**one, "position": (90e3, 20e3, 0.0), "velocity": (-200.0, 0.0, 0.0)})
    job, first, second = JobDirectory(tmp_path), advance(started(given), 60), Simulation(given)
    assert first.particles.read("plastic_dilation")["plastic_dilation"].max() > 1e-4
    save_checkpoint(job, first, {})
    load_checkpoint(job, second)
    for each in (first, second):
        advance(each, 120)
    assert_same_state(first, second)


@pytest.mark.usefixtures("taichi")
def test_without_a_checkpoint_nothing_is_restored(tmp_path: Path) -> None:
    assert load_checkpoint(JobDirectory(tmp_path), Simulation(pair(**BARE))) is None


@pytest.mark.parametrize("missing", ["time", "moved_out", "gravity_due", "scene_hash"])
@pytest.mark.usefixtures("taichi")
def test_an_incomplete_checkpoint_gives_way_to_the_one_before(tmp_path: Path, missing: str) -> None:
    job, simulation = JobDirectory(tmp_path), started(pair(**BARE))
    for _ in range(2):
        simulation.advance(simulation.scene.end_time, steps=5)
        save_checkpoint(job, simulation, {"steps": float(simulation.step)})
    newest = read_dataset(job.checkpoint)
    del newest.attrs[missing]
    write_dataset(job.checkpoint, newest)
    restored = Simulation(simulation.scene)
    progress = load_checkpoint(job, restored)
    assert progress == {"steps": float(restored.step)} and 0 < restored.step < simulation.step


@pytest.mark.usefixtures("taichi")
def test_a_checkpoint_of_another_scene_or_version_is_refused(tmp_path: Path) -> None:
    job, simulation = JobDirectory(tmp_path), started(pair(**BARE))
    save_checkpoint(job, simulation, {})
    another = pair(**BARE).model_copy(update={"seed": 2})
    (tmp_path / "scene.json").write_text(another.canonical())
    with pytest.raises(JobError, match="belongs to another scene"):
        load_checkpoint(job, Simulation(another))
    other = read_dataset(job.checkpoint).assign_attrs(physics_version=PHYSICS_VERSION + 1)
    write_dataset(job.checkpoint, other)
    with pytest.raises(JobError, match=f"physics version {PHYSICS_VERSION + 1}"):
        load_checkpoint(job, Simulation(simulation.scene))


def test_a_file_of_the_scene_as_a_version_with_fewer_keys_wrote_it_belongs_to_it(tmp_path: Path) -> None:
    scene = pair(**BARE)
    table = json.loads(scene.canonical())
    del table["numerics"]["filter_time"]
    (tmp_path / "scene.json").write_text(json.dumps(table))
    written = hashlib.sha256((tmp_path / "scene.json").read_bytes()).hexdigest()
    dataset = xr.Dataset(attrs={"physics_version": PHYSICS_VERSION, "scene_hash": written})
    refuse_foreign(dataset, scene, tmp_path / "checkpoint.nc")


def test_a_bare_scene_writes_all_variables_and_resumes_to_the_same_bits(tmp_path: Path) -> None:
    given = pair(**BARE).model_copy(update={"end_time": 300.0})
    (tmp_path / "scene.json").write_text(given.canonical())
    assert run_job(tmp_path, Options()).state == "done"
    final, history = read_dataset(tmp_path / "final.nc"), read_dataset(tmp_path / "history.nc")
    for name in ("energy", "damage"):
        assert final[name].shape == (200,) and not final[name].any()
    assert not history["internal_energy"].any() and not history["gravitational_energy"].any()

    backend.start(threads=1)
    job, first = JobDirectory(tmp_path), advance(started(given), 20)
    save_checkpoint(job, first, {})
    expected = advance(first, 40).particles.read()
    assert not {"E", "b_minus_I", "damage_root", "acceleration"} & set(read_dataset(job.checkpoint).data_vars)
    backend.start(threads=1)
    second = Simulation(given)
    assert load_checkpoint(job, second) == {}
    found = advance(second, 40).particles.read()
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values, err_msg=name)
