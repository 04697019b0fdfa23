"""From studies to jobs."""

from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from campaigns.campaign import Campaign
from campaigns.dotted_keys import flatten, nest, scalar_keys, value_at
from campaigns.expansion import expand
from campaigns.study import SHIPPED, Study, find_study, read_study
from engine.scene.collision import Collision
from engine.scene.fields import validate
from engine.scene.scene import Scene

VELOCITIES = st.lists(st.integers(50, 400), min_size=1, max_size=3, unique=True)
ANGLES = st.lists(st.integers(0, 90), min_size=1, max_size=3, unique=True)


def grid(**axes: list[float]) -> Campaign:
    return expand(Study(name="grid", axes=axes), "test")


def ids(campaign: Campaign) -> set[str]:
    return {job.id for job in campaign.jobs}


@settings(max_examples=20, deadline=None)
@given(VELOCITIES, ANGLES)
def test_grid_is_the_product(velocities, angles):
    campaign = grid(velocity=velocities, angle=angles)
    assert campaign.dims == ("velocity", "angle")
    assert [tuple(job.index.values()) for job in campaign.jobs] == [(v, a) for v in velocities for a in angles]
    assert len(ids(campaign)) == len(velocities) * len(angles)
    assert all(job.collision.velocity == job.index["velocity"] for job in campaign.jobs)


@settings(max_examples=20, deadline=None)
@given(VELOCITIES, ANGLES)
def test_whole_numbers_name_the_same_jobs(velocities, angles):
    floats = grid(velocity=[float(v) for v in velocities], angle=[float(a) for a in angles])
    assert floats.jobs == grid(velocity=velocities, angle=angles).jobs


@settings(max_examples=20, deadline=None)
@given(VELOCITIES, ANGLES, st.randoms())
def test_order_in_the_file_has_no_meaning(velocities, angles, random):
    shuffled = random.sample(velocities, len(velocities))
    assert ids(grid(angle=angles, velocity=shuffled)) == ids(grid(velocity=velocities, angle=angles))


@settings(max_examples=20, deadline=None)
@given(VELOCITIES, ANGLES, st.integers(500, 600))
def test_extension_keeps_all_jobs(velocities, angles, further):
    assert ids(grid(velocity=velocities, angle=angles)) < ids(grid(velocity=[*velocities, further], angle=angles))


@settings(max_examples=20, deadline=None)
@given(VELOCITIES, ANGLES)
def test_campaign_survives_its_file(velocities, angles):
    campaign = grid(velocity=velocities, angle=angles)
    assert validate(Campaign, campaign.content(), "test") == campaign


def test_order_of_further_axes_has_no_meaning():
    axes = {"seed": [1, 2], "materials.basalt.friction": [0.5], "viscosity.shear": [0.0, 1e5]}
    found = [
        grid(velocity=[100], angle=[5], **{key: axes[key] for key in order}) for order in permutations(sorted(axes))
    ]
    assert all(campaign.jobs == found[0].jobs for campaign in found)
    assert found[0].dims == ("velocity", "angle", "materials.basalt.friction", "seed", "viscosity.shear")


def test_axes_can_be_nested_tables():
    nested = expand(Study(name="n", axes={"velocity": [1], "angle": [5], "viscosity": {"shear": [1e3]}}), "test")
    assert nested.jobs[0].collision.viscosity.shear == 1e3
    assert nested.jobs == grid(**{"velocity": [1], "angle": [5], "viscosity.shear": [1e3]}).jobs


def test_materials_spins_and_their_constants_are_axes():
    ice = {"cohesion": 1e6, "intact_friction": 1.0, "melt_energy": 7e5, "friction": 0.6}
    axes = {
        "velocity": [100],
        "angle": [5],
        "projectile.material": ["basalt", "ice"],
        "target.spin_period": [1e9, 4, 8],
        "materials.basalt.friction": [0.5, 0.7],
    }
    study = Study(name="n", collision={"materials": {"ice": ice}}, axes=axes)
    campaign = expand(study, "test")
    assert campaign.dims == (
        "velocity",
        "angle",
        "materials.basalt.friction",
        "projectile.material",
        "target.spin_period",
    )
    assert campaign.coords["target.spin_period"] == (1e9, 4.0, 8.0)
    assert len({job.id for job in campaign.jobs}) == 12
    last = campaign.jobs[-1]
    assert last.id.startswith("v0100_a05_materials.basalt.friction0.7_projectile.material-i")
    target, projectile = last.collision.scene().bodies
    assert (target.material.friction, projectile.material.friction) == (0.7, 0.6)
    assert target.spin[2] == pytest.approx(2.0 * 3.141592653589793 / (8.0 * 3600.0), rel=1e-9)
    assert validate(Campaign, campaign.content(), "test") == campaign


def test_a_constant_that_an_axis_gives_needs_no_shared_value():
    ice = {"cohesion": 1e6, "intact_friction": 1.0, "melt_energy": 7e5}
    shared = {"target": {"material": "ice"}, "materials": {"ice": ice}}
    axes = {"velocity": [100], "angle": [5], "materials.ice.friction": [0.5, 0.6]}
    jobs = expand(Study(name="n", collision=shared, axes=axes), "test").jobs
    assert [job.collision.scene().bodies[1].material.friction for job in jobs] == [0.5, 0.6]


def test_axes_and_cases_give_the_same_job():
    (from_axes,) = grid(velocity=[100], angle=[5], sound_speed=[0.5]).jobs
    (from_case,) = expand(
        Study(name="n", collision={"angle": 5}, cases=[{"sound_speed": 0.5, "velocity": 100, "angle": 5.0}]), "test"
    ).jobs
    assert from_axes.id == from_case.id
    assert from_case.index == {"case": "v0100_a05_sound_speed0.5"}


def test_case_names_do_not_depend_on_other_cases():
    cases = [{"velocity": 100, "angle": 5}, {"velocity": 100, "angle": 5, "end_time": 10.0}]
    both = expand(Study(name="n", cases=cases), "test")
    alone = expand(Study(name="n", cases=cases[:1]), "test")
    assert both.jobs[0] == alone.jobs[0]
    assert both.dims == ("case",)
    assert both.coords["case"] == ("v0100_a05", "v0100_a05_end_time10")


@pytest.mark.parametrize("key", ["materials.basalt", "viscosity", "materials"])
def test_a_case_that_sets_a_whole_table_is_named_by_its_key(key):
    (job,) = expand(Study(name="n", collision={"velocity": 1, "angle": 5}, cases=[nest({key: {}})]), "test").jobs
    assert job.index == {"case": key}


def test_every_case_is_run_for_every_combination_of_the_axes():
    cases = [{}, {"name": "fine", "particles": 40000}]
    campaign = expand(Study(name="n", axes={"velocity": [1, 2], "angle": [5], "seed": [1, 2]}, cases=cases), "test")
    assert campaign.dims == ("case", "velocity", "angle", "seed")
    assert campaign.coords["case"] == ("base", "fine")
    assert len(campaign.jobs) == 8
    assert campaign.jobs[-1].id.startswith("fine_v0002_a05_seed2-")
    assert campaign.jobs[-1].collision.particles == 40000
    assert ids(grid(velocity=[1, 2], angle=[5], seed=[1, 2])) != ids(campaign)
    assert {job.id[-8:] for job in campaign.jobs[:4]} == {j.id[-8:] for j in grid(velocity=[1, 2], angle=[5]).jobs} | {
        job.id[-8:] for job in grid(velocity=[1, 2], angle=[5], seed=[2]).jobs
    }


def test_a_case_that_sets_an_axis_is_run_at_that_value_only():
    cases = [{}, {"particles": 40000, "seed": 2}]
    campaign = expand(
        Study(name="n", collision={"velocity": 1, "angle": 5}, axes={"seed": [1, 2]}, cases=cases), "test"
    )
    assert [tuple(job.index.values()) for job in campaign.jobs] == [
        ("base", 1),
        ("base", 2),
        ("particles40000", 2),
    ]
    assert validate(Campaign, campaign.content(), "test") == campaign


def test_false_leaves_parts_out_of_the_cases_and_axes_of_a_study():
    cases = [{}, {"gravity": False}, {"viscosity": False, "fracture": False, "name": "loose"}]
    shared = {"viscosity": {"shear": 1e5}, "output": {"snapshot_interval": False}}
    axes = {"velocity": [200], "angle": [5], "seed": [1, 2]}
    campaign = expand(Study(name="n", collision=shared, axes=axes, cases=cases), "test")
    physics = [job.collision.scene().physics for job in campaign.jobs[::2]]
    assert [part.gravity is None for part in physics] == [False, True, False]
    assert [part.viscosity is None for part in physics] == [False, False, True]
    assert [part.fracture is None for part in physics] == [False, False, True]
    assert [job.collision.output.snapshot_interval for job in campaign.jobs] == [None] * 6
    assert validate(Campaign, campaign.content(), "test") == campaign


def test_error_bars_run_every_point_at_two_resolutions_with_all_seeds():
    bars = {"coarser": 0.3, "seeds": [4, 2]}
    study = Study(name="n", collision={"particles": 1000}, axes={"velocity": [1, 2], "angle": [5]}, error_bars=bars)
    campaign = expand(study, "test")
    assert campaign.dims == ("velocity", "angle", "resolution", "seed")
    assert campaign.coords["resolution"] == ("coarse", "fine") and campaign.coords["seed"] == (4, 2)
    assert [(job.collision.particles, job.collision.seed) for job in campaign.jobs] == [
        (300, 4),
        (300, 2),
        (1000, 4),
        (1000, 2),
    ] * 2
    assert validate(Campaign, campaign.content(), "test") == campaign
    plain = grid(velocity=[1, 2], angle=[5], seed=[4], particles=[1000])
    assert {job.id[-8:] for job in plain.jobs} < {job.id[-8:] for job in campaign.jobs}


def test_the_order_of_error_bars_changes_no_job():
    ids = [
        [
            job.id
            for job in expand(
                Study(name="n", axes={"velocity": [1], "angle": [5]}, error_bars={"seeds": [1, 2], **order}), "test"
            ).jobs
        ]
        for order in ({}, {"order": 2.0})
    ]
    assert ids[0] == ids[1] and len(ids[0]) == 4


def test_expansion_leaves_the_study_as_it_is():
    study = Study(name="n", collision={"viscosity": {}}, axes={"velocity": [1], "angle": [5], "viscosity.bulk": [1]})
    before = study.model_dump()
    expand(study, "test")
    assert study.model_dump() == before


@pytest.mark.parametrize("path", sorted(SHIPPED.glob("*.toml")), ids=lambda path: path.stem)
def test_every_shipped_study_says_what_it_is_for_and_runs_no_simulation_twice(path):
    study = read_study(path)
    campaign = expand(study, path.stem)
    assert campaign.name == path.stem, "make campaign STUDY=name finds it, and its results, by one name"
    assert len(study.description.split()) > 3
    scenes = [job.collision.scene().canonical() for job in campaign.jobs]
    assert len(set(scenes)) == len(scenes) > 0


@pytest.mark.parametrize("path", sorted(SHIPPED.glob("*.toml")), ids=lambda path: path.stem)
def test_a_scene_has_the_hash_of_its_job_also_after_it_was_written_and_read(path):
    for job in expand(read_study(path), path.stem).jobs:
        scene = job.collision.scene()
        assert Scene.model_validate_json(scene.model_dump_json()).hash() == scene.hash()
        assert job.id.endswith(scene.hash()[:8])


def test_talk_cases_end_at_their_own_times():
    campaign = expand(read_study(find_study("talk2025")), "talk2025")
    assert [(c.collision.velocity, c.collision.angle, c.collision.end_time) for c in campaign.jobs] == [
        (200.0, 5.0, 15200.0),
        (200.0, 15.0, 10300.0),
        (300.0, 25.0, 5500.0),
    ]


def test_keys_lead_to_every_single_value():
    collision = Collision(velocity=1, angle=1, viscosity={}, fracture={})
    other_form = {"materials.NAME.eos.K", "materials.NAME.eos.n"}
    assert other_form <= set(scalar_keys(Collision))
    for key in set(scalar_keys(Collision)) - other_form:
        assert not isinstance(value_at(collision, key.replace("NAME", "basalt")), dict)
    assert {"velocity", "viscosity.shear", "materials.NAME.eos.A"} <= set(scalar_keys(Collision))
    assert "viscosity" not in set(scalar_keys(Collision))


NAMES = st.text("abc", min_size=1, max_size=2)
TABLES = st.recursive(
    st.dictionaries(NAMES, st.integers(), min_size=1), lambda inner: st.dictionaries(NAMES, inner, min_size=1)
)


@settings(max_examples=50, deadline=None)
@given(TABLES)
def test_nesting_undoes_flattening(table):
    assert nest(flatten(table)) == table


def test_later_key_wins():
    assert nest({"a": None, "a.b": 1}) == {"a": {"b": 1}}
    assert nest({"a.b": 1, "a": None}) == {"a": None}
