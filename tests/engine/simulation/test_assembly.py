"""Physics that a scene leaves out is not allocated, not compiled and not run."""

from typing import Any

import numpy as np
import pytest
from taichi.lang.kernel_impl import Func, Kernel

from engine.gravity.self_gravity import SelfGravity
from engine.profile.parts import parts_of
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import CORE_FIELDS
from engine.verification.problems.column import StandingWave
from tests.helpers.device import worst
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
        for stage in (simulation.transfer, *simulation.transfer.stages):
            for kernel in stage.kernels:
                kernel()
        if isinstance(simulation.gravity, SelfGravity):
            simulation.gravity.solve(potential=False)
    return simulation, names


def held(simulation: Simulation) -> set[str]:
    """Particle quantities that have a field, less those that always do."""
    return set(simulation.particles.allocated) - set(CORE_FIELDS)


def field_names(simulation: Simulation) -> set[str]:
    return {f"{part.name}.{name}" for part in parts_of(simulation) for name in part.fields}


PARTS: dict[str, tuple[set[str], list[str]]] = {
    "energy": (
        {"E", "half_step_work", "transfer_heat", "affine_loss"},
        ["laws.energy.InternalEnergy", "laws.dissipation.Dissipation", "laws.tillotson.condensed"],
    ),
    "shear": ({"b_minus_I"}, ["laws.shear.Hencky", "laws.shear.deform", "device.tensors.half_log"]),
    "strength": ({"plastic_heat"}, ["laws.strength.Strength"]),
    "fracture": ({"damage_root"}, ["laws.fracture.", "laws.damage.Damage", "device.tensors.largest_eigenvalue"]),
    "gravity": ({"acceleration"}, ["gravity.barnes_hut.", "gravity.multipoles.", "gravity.self_gravity."]),
    "viscosity": ({"viscous_heat"}, ["laws.viscosity.Viscosity"]),
    "walls": (set(), ["mpm.walls.Walls", "mpm.filtered.WallContact"]),
}
"""Particle fields and code of every part of the physics."""


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
    expected = set().union(*(fields for part, (fields, _) in PARTS.items() if part not in left_out))
    account = {"plastic_heat", "viscous_heat"} if "energy" in left_out else set()
    assert held(simulation) == expected - account


@pytest.mark.usefixtures("taichi")
def test_an_elastic_column_pays_for_elasticity_alone(monkeypatch):
    simulation, names = code(StandingWave(8).scene, monkeypatch)
    assert held(simulation) == PARTS["shear"][0] | PARTS["energy"][0]
    owners = {part.name for part in parts_of(simulation) if part.fields}
    passes = {"kick", "projection", "correction"}
    laws = {"response", "eos", "energy", "dissipation", "shear"}
    sorting, sums = {"blocks", "sorted", "sums", "permutation"}, {"ledger", "motion_sum", "energy_sum"}
    assert owners == {"particles", "clock", "stencil", "scheme"} | sorting | sums | passes | laws
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
