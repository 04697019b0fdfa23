"""What a scene leaves out is not allocated, not compiled, and not run."""

from typing import Any

import numpy as np
import pytest
from taichi.lang.kernel_impl import Func, Kernel

from engine.device import backend
from engine.gravity.self_gravity import SelfGravity
from engine.job.checkpoint import load_checkpoint, save_checkpoint
from engine.job.directory import JobDirectory
from engine.job.session import Options, run_job
from engine.job.storage import read_dataset
from engine.laws.tillotson import ColdTillotson
from engine.profile.parts import allocated_bytes, parts_of
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import CORE_FIELDS, FIELD_TYPES, Particles
from engine.verification.problems.column import StandingWave
from tests.helpers.device import evaluate, worst
from tests.helpers.oracle import RHO0, K
from tests.helpers.scenes import advance, body, scene, started

FULL: dict[str, Any] = {"viscosity": {"shear": 1e5}, "walls": [{"point": [0.0, 0.0, -1e6]}]}
BARE: dict[str, Any] = {"energy": False, "shear": False, "strength": False, "fracture": None, "gravity": None}


def rock(**physics: Any) -> Scene:
    """Two intact bodies in contact."""
    one = body(damage=0.0)
    return scene(one, {**one, "position": (90e3, 0.0, 0.0)}, physics=physics)


def code(given: Scene, monkeypatch: pytest.MonkeyPatch) -> tuple[Simulation, set[str]]:
    """A simulation, and names of all kernels and device functions that its step and its gravity are compiled from.

    Kernels are translated as for a run, and then neither compiled to machine code nor run, which would take minutes.
    """
    simulation, names = started(given), set()
    call, materialize = Func.__call__, Kernel.materialize

    def record(own: Any) -> None:
        names.add(f"{own.func.__module__}.{own.func.__qualname__}")

    def recorded_call(self: Func, *arguments: Any, **options: Any) -> Any:
        record(self)
        return call(self, *arguments, **options)

    def recorded_materialize(self: Kernel, *arguments: Any, **options: Any) -> Any:
        record(self)
        return materialize(self, *arguments, **options)

    with monkeypatch.context() as patch:
        patch.setattr(Func, "__call__", recorded_call)
        patch.setattr(Kernel, "materialize", recorded_materialize)
        patch.setattr(Kernel, "launch_kernel", lambda *arguments: None)
        simulation.transfer.step()
        if isinstance(simulation.gravity, SelfGravity):
            simulation.gravity.solve(potential=False)
    return simulation, names


def held(simulation: Simulation) -> set[str]:
    """Particle quantities that have a field, less those that always do."""
    return set(simulation.particles.allocated) - set(CORE_FIELDS)


def field_names(simulation: Simulation) -> set[str]:
    return {f"{part.name}.{name}" for part in parts_of(simulation) for name in part.fields}


PARTS = {
    "energy": ("E", ["laws.energy.InternalEnergy", "laws.tillotson.condensed"]),
    "shear": ("b_minus_I", ["laws.shear.Hencky", "laws.shear.deform", "device.tensors.half_log"]),
    "strength": (None, ["laws.strength.Strength"]),
    "fracture": ("damage_root", ["laws.fracture.", "laws.damage.Damage", "device.tensors.largest_eigenvalue"]),
    "gravity": ("acceleration", ["gravity.barnes_hut.", "gravity.multipoles.", "gravity.self_gravity."]),
    "viscosity": (None, ["laws.viscosity.Viscosity"]),
    "walls": (None, ["mpm.walls."]),
}
"""Particle field and code of every part of the physics."""


def runs(part: str, names: set[str]) -> bool:
    """Whether any code of a part was compiled."""
    return any(name.startswith(f"engine.{code}") for code in PARTS[part][1] for name in names)


@pytest.mark.parametrize(
    ("left_out", "changes"),
    [
        (set(), {}),
        ({"energy"}, {"energy": False}),
        ({"fracture"}, {"fracture": None}),
        ({"fracture", "strength"}, {"fracture": None, "strength": False}),
        ({"fracture", "strength", "shear"}, {"fracture": None, "strength": False, "shear": False}),
        ({"gravity"}, {"gravity": None}),
        ({"viscosity"}, {"viscosity": None}),
        ({"walls"}, {"walls": []}),
        (set(PARTS), {**BARE, "viscosity": None, "walls": []}),
    ],
    ids=lambda value: "-".join(sorted(value)) or "none" if isinstance(value, set) else "",
)
@pytest.mark.usefixtures("taichi")
def test_each_part_is_there_exactly_when_the_scene_names_it(monkeypatch, left_out, changes):
    simulation, names = code(rock(**{**FULL, **changes}), monkeypatch)
    assert {part for part in PARTS if not runs(part, names)} == left_out
    assert held(simulation) == {name for part, (name, _) in PARTS.items() if name and part not in left_out}


@pytest.mark.usefixtures("taichi")
def test_an_elastic_column_pays_for_elasticity_alone(monkeypatch):
    simulation, names = code(StandingWave(8).scene, monkeypatch)
    assert held(simulation) == {"b_minus_I", "E"}
    owners = {part.name for part in parts_of(simulation) if part.fields}
    assert owners == {"particles", "clock", "transfer", "constitution", "eos", "energy", "shear"}
    assert not [part for part in PARTS if part not in ("energy", "shear") and runs(part, names)]


@pytest.mark.usefixtures("taichi")
def test_an_elastic_column_without_energy_is_the_same_to_second_order():
    """Thermal pressure is second order in a strain of 1e-7."""
    column = StandingWave(8).scene
    state = {"v": 1e-3 * np.sin(2e-3 * np.pi * started(column).particles.read("x")["x"])}
    cold = column.model_copy(update={"physics": column.physics.model_copy(update={"energy": False})})
    ends = [advance(started(each, **state), 16) for each in (column, cold)]
    warm_end, cold_end = (end.particles.read("x", "v", "tau", "E") for end in ends)
    assert warm_end["E"].any() and not cold_end["E"].any()
    assert ends[1].totals().internal_energy == 0.0 < ends[0].totals().internal_energy
    assert not np.array_equal(warm_end["tau"], cold_end["tau"])
    assert worst(cold_end["v"], warm_end["v"], 1e-3) < 1e-6


@pytest.mark.usefixtures("taichi")
def test_without_energy_pressure_follows_the_cold_curve():
    scene_of_two = rock(energy=False)
    law = ColdTillotson(scene_of_two.materials)
    mu, zeros = np.linspace(-0.4, 3.0, 500), np.zeros(500, np.int32)
    P, c2 = evaluate(law.evaluate, zeros, mu, np.full(500, 1e8), zeros, outputs=((), ()))
    assert worst(P, K * mu + K * mu**2, K * np.abs(mu)) < 1e-15
    assert worst(c2, (K + 2.0 * K * mu) / RHO0, K / RHO0) < 1e-15


@pytest.mark.usefixtures("taichi")
def test_bodies_start_in_balance_on_the_cold_curve():
    state = started(scene(body(hydrostatic=True), physics={"energy": False})).particles.read("j", "tau", "E")
    mu = -state["j"] / (1.0 + state["j"])
    expected = -state["tau"][:, 0] / (1.0 + state["j"])
    assert worst(K * mu + K * mu**2, expected, expected.max()) < 1e-13
    assert not state["E"].any()


@pytest.mark.usefixtures("taichi")
def test_damage_that_only_stays_is_kept_without_flaws():
    simulation = advance(started(scene(body(damage=0.3))), 2)
    np.testing.assert_allclose(simulation.particles.read("damage_root")["damage_root"] ** 3, 0.3, rtol=1e-14)
    assert "fracture.strain" not in field_names(simulation)


@pytest.mark.usefixtures("taichi")
def test_uniform_gravity_needs_no_field_of_particles():
    g = (1.0, -2.0, 3.0)
    simulation = advance(started(scene(body(), physics={**BARE, "uniform_gravity": g})), 20)
    before = started(scene(body(), physics=BARE)).particles.read("x")["x"]
    assert held(simulation) == {"damage_root"}
    assert allocated_bytes(simulation.gravity.pull) == 24
    state, t = simulation.particles.read("x", "v", "mass"), simulation.time
    np.testing.assert_allclose(state["v"], np.tile(np.multiply(g, t), (100, 1)), rtol=1e-11)
    # kicks come before drifts, so positions gain half a step of speed; energy is lost by as much height
    fallen = (state["x"] - before).mean(axis=0)
    np.testing.assert_allclose(fallen, np.multiply(g, 0.5 * t**2), rtol=0.1)
    assert simulation.gravity.energy() == pytest.approx(-float((state["mass"] * (state["x"] @ g)).sum()), rel=1e-13)


@pytest.mark.usefixtures("taichi")
def test_a_quantity_that_no_part_holds_is_zero_and_stays_so():
    particles = Particles(3)
    assert set(particles.allocated) == set(CORE_FIELDS)
    zeros = particles.read()
    assert list(zeros) == list(FIELD_TYPES)
    assert zeros["b_minus_I"].shape == (3, 6) and zeros["acceleration"].shape == (3, 3) and zeros["E"].shape == (3,)
    particles.write({"E": np.zeros(3)})
    with pytest.raises(ValueError, match="'E'"):
        particles.write({"E": np.ones(3)})
    particles.require("E")
    particles.write({"E": np.ones(3)})
    assert particles.read("E")["E"].all()


def test_a_bare_scene_writes_all_variables_and_resumes_to_the_same_bits(tmp_path):
    given = rock(**BARE).model_copy(update={"end_time": 300.0})
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
    advance(second, 40)
    for name, values in expected.items():
        np.testing.assert_array_equal(second.particles.read(name)[name], values, err_msg=name)
