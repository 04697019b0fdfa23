"""Parts of a simulation and their fields."""

import numpy as np
import pytest
import taichi as ti

from engine.device.backend import Real, mat3, vec6
from engine.device.fields import per_body
from engine.mpm.filtered import Motion
from engine.profile.parts import allocated_bytes, own_fields, parts_of
from tests.helpers.scenes import body, scene, started

pytestmark = pytest.mark.usefixtures("taichi")


def test_every_field_belongs_to_one_part_the_innermost() -> None:
    simulation = started(scene(body(), physics={"gravity": {"opening": 0.5}}))
    parts = {part.name: part for part in parts_of(simulation)}
    fields = [id(field) for part in parts.values() for field in part.fields.values()]
    assert len(fields) == len(set(fields))
    assert {"x", "v"} <= set(parts["particles"].fields)
    assert "acceleration" in parts["rigid"].fields and "acceleration" not in parts["gravity"].fields
    assert "b_minus_I" in parts["shear"].fields and "b_minus_I" not in parts["particles"].fields
    assert parts["gravity"].content is simulation.gravity


def test_kernels_are_found_also_those_of_a_base_class() -> None:
    parts = {part.name: part for part in parts_of(started(scene(body(), physics={"gravity": {"opening": 0.5}})))}
    of_tree, of_gravity = {"gather_leaves", "merge_level", "walk_all"}, {"take_particles", "find_extent"}
    assert set(parts["gravity"].kernels) == of_tree | of_gravity | {"fill_slots", "take_results"}


def test_every_stage_of_a_step_is_one_part() -> None:
    simulation = started(scene(body(), physics={"walls": [{"point": [0.0, 0.0, -1e6]}]}))
    stages = [part for part in parts_of(simulation) if part.content in simulation.transfer.stages]
    grid = {"particles_to_grid", "update_grid", "grid_to_particles"}
    assert [(part.name, set(part.kernels)) for part in stages] == [
        ("kick", grid),
        ("wall", grid),
        ("drift", {"move"}),
        ("projection", grid),
        ("correction", grid),
    ]


def test_a_part_that_a_scene_leaves_out_has_neither_fields_nor_kernels() -> None:
    parts = {part.name: part for part in parts_of(started(scene(body())))}
    assert {name for name in ("gravity", "viscosity", "walls", "shear", "transfer") if parts[name].is_empty} == {
        "gravity",
        "viscosity",
        "walls",
    }


def test_memory_counts_entries_and_components() -> None:
    fields = {
        8 * 5: ti.field(Real, 5),
        4 * 12: ti.field(ti.i32, (3, 4)),
        8 * 6 * 7: vec6.field(shape=7),
        8 * 9: mat3.field(shape=()),
        8 * 2 * 1024: per_body(density=np.ones(3), modulus=np.ones(3)),
        8 * 12 * 9: Motion.field(shape=9),
    }
    assert [allocated_bytes(field) for field in fields.values()] == list(fields)


def test_only_fields_among_attributes_count() -> None:
    class Holder:
        def __init__(self) -> None:
            self.count, self.field, self.table = 3, ti.field(Real, 3), per_body(density=[1.0])

    assert set(own_fields(Holder())) == {"field", "table"}
