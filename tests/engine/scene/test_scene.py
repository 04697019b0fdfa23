import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.errors import SceneError
from engine.scene.fields import validate
from engine.scene.scene import Scene, Sphere, read_scene, scene_in
from engine.simulation.initial_conditions import initial_state

BODY: dict[str, Any] = {"radius": 50e3, "particles": 1000}
BOX: dict[str, Any] = {"size": [1.0, 1.0, 1.0], "lattice": [2, 2, 2]}
SCENE: dict[str, Any] = {"bodies": [BODY], "end_time": 10.0}


def scene(**changes: Any) -> Scene:
    return validate(Scene, {**SCENE, **changes}, "scene.toml")


def with_body(**changes: Any) -> dict[str, Any]:
    return {"bodies": [BODY, {**BODY, **changes}]}


def with_material(**changes: Any) -> dict[str, Any]:
    return with_body(material={"name": "basalt", **changes})


BAD = {
    "no bodies": ({"bodies": []}, "'bodies'", "at least 1"),
    "no particles": (with_body(particles=0), "'bodies.1.particles'", "greater than or equal to 1", "given 0"),
    "negative radius": (with_body(radius=-1.0), "'bodies.1.radius'", "greater than 0", "-1.0"),
    "flat position": (with_body(position=[0.0, 1.0]), "bodies.1.position"),
    "infinite position": (with_body(position=[0.0, 0.0, float("inf")]), "'bodies.1.position.2'", "finite", "inf"),
    "misspelt body key": (with_body(veloctiy=[1, 0, 0]), "'bodies.1.veloctiy'", "did you mean 'velocity'"),
    "more than all damage": (with_body(damage=1.5), "'bodies.1.damage'", "less than or equal to 1", "1.5"),
    "negative density": (with_material(rho0=-1.0), "'bodies.1.material.rho0'", "-1.0"),
    "flat distribution": (with_material(weibull_m=0.5), "'bodies.1.material.weibull_m'", "0.5"),
    "strength below cohesion": (with_material(strength_limit=1e7), "strength_limit", "cohesion", "10000000.0"),
    "vapour before vaporisation": (with_material(eos={"E_cv": 4e6}), "E_cv", "E_iv", "4000000.0"),
    "ends before it starts": ({"end_time": -5.0}, "end_time -5.0", "start_time 0.0"),
    "starts at infinity": ({"start_time": float("-inf")}, "'start_time'", "finite", "-inf"),
    "no end": ({"end_time": None}, "'end_time'", "None"),
    "strength without shear": (
        {"physics": {"shear": False, "fracture": None}},
        "'strength'",
        "shear = true",
        "fracture = false",
    ),
    "fracture without strength": ({"physics": {"strength": False}}, "'fracture'", "strength = true"),
    "pressure that nothing balances": (
        {"bodies": [{**BODY, "hydrostatic": True}], "physics": {"gravity": None}},
        "'hydrostatic'",
        "needs self-gravity",
    ),
    "two gravities": ({"physics": {"uniform_gravity": [0, 0, -1]}}, "'uniform_gravity'", "gravity = false"),
    "yes for a table": ({"physics": {"gravity": True}}, "'physics.gravity'", "a table of keys", "True"),
    "misspelt physics": ({"physics": {"gravty": None}}, "'physics.gravty'", "did you mean 'gravity'"),
    "misspelt gravity": ({"physics": {"gravity": {"softning": 1}}}, "softning", "did you mean 'softening'"),
    "no interval": ({"physics": {"gravity": {"interval": 0}}}, "'physics.gravity.interval'", "greater than 0"),
    "thin gas": ({"physics": {"viscosity": {"shear": -1.0}}}, "'physics.viscosity.shear'", "-1.0"),
    "silence": ({"physics": {"sound_speed": 0.0}}, "'physics.sound_speed'", "greater than 0", "0.0"),
    "faster than sound": ({"physics": {"sound_speed": 1.5}}, "'physics.sound_speed'", "less than or equal to 1", "1.5"),
    "empty cells": ({"numerics": {"particles_per_cell": 0.0}}, "'numerics.particles_per_cell'", "0.0"),
    "no steps": ({"numerics": {"cfl": 0.0}}, "'numerics.cfl'", "0.0"),
    "word for a flag": ({"physics": {"shear": "perhaps"}}, "'physics.shear'", "boolean", "'perhaps'"),
    "switch for a number": (with_body(radius=True), "'bodies.1.radius'", "a number, not true or false", "True"),
    "switch for a count": (with_body(particles=True), "'bodies.1.particles'", "a number, not true or false"),
    "switch in a vector": (with_body(position=[0.0, False, 0.0]), "'bodies.1.position.1'", "not true or false"),
    "more particles than indices": (with_body(particles=10**10), "'bodies.1.particles'", "less than", "1073741824"),
    "far more particles": (with_body(particles=1e24), "'bodies.1.particles'", "too large", "1e+24"),
    "too many particles in all": (with_body(particles=2**30), "'bodies' have 1073742824 particles in all", "at most"),
    "no body": ({"bodies": [3]}, "'bodies.0'", "a table of keys", "3"),
    "sphere and box": ({"bodies": [{**BOX, "radius": 1.0}]}, "unknown key 'bodies.0.radius'", "known keys", "lattice"),
    "box without lattice": ({"bodies": [{"size": [1.0, 1.0, 1.0]}]}, "missing key 'bodies.0.lattice'"),
    "box without size": ({"bodies": [{"lattice": [1, 1, 1]}]}, "missing key 'bodies.0.size'"),
    "misspelt friction": ({"physics": {"walls": [{"friction": "stik"}]}}, "walls.0.friction'", "'stick' or", "number"),
    "word for a table": ({"numerics": "f32"}, "'numerics'", "a table of keys", "'f32'"),
    "key of a table inside": ({"cfl": 0.1}, "unknown key 'cfl'", "did you mean 'numerics.cfl'"),
    "part of physics outside": ({"gravity": {}}, "unknown key 'gravity'", "did you mean 'physics.gravity'"),
    "key without relatives": ({"zzzz": 1}, "unknown key 'zzzz'", "known keys: physics, bodies"),
}


@pytest.mark.parametrize(("change", "told"), [(case[0], case[1:]) for case in BAD.values()], ids=list(BAD))
def test_bad_input_is_one_line_with_file_key_value_and_the_way_out(change, told):
    with pytest.raises(SceneError) as error:
        scene(**change)
    message = str(error.value)
    assert message.startswith("scene.toml: ") and "\n" not in message
    for word in told:
        assert word in message


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("scene.json", b"{", "not valid JSON"),
        ("scene.toml", b"bodies = [", "not valid TOML"),
        ("scene.json", b"[1]", "table of keys"),
        ("scene.toml", b"\xff\xfe", "cannot be read"),
        ("scene.json", b"", "not valid JSON"),
    ],
)
def test_an_unreadable_file_is_named(tmp_path: Path, name: str, content: bytes, told: str):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(SceneError, match=told) as error:
        read_scene(path)
    assert str(error.value).startswith(f"{path}: ")


def test_a_directory_without_a_scene_says_what_to_write(tmp_path: Path):
    with pytest.raises(SceneError, match=r"scene\.json or scene\.toml"):
        scene_in(tmp_path)


def test_a_directory_with_two_scenes_is_refused(tmp_path: Path):
    for name in ("scene.json", "scene.toml"):
        (tmp_path / name).write_text("")
    with pytest.raises(SceneError, match=r"contains scene\.json and scene\.toml"):
        scene_in(tmp_path)


def test_a_scene_survives_being_written_and_read(tmp_path: Path):
    one = scene(physics={"viscosity": {"shear": 1e5}}, bodies=[BODY, {**BODY, "spin": [0, 0, 1e-4]}])
    (tmp_path / "scene.json").write_text(one.canonical())
    assert scene_in(tmp_path) == one
    assert json.loads(one.canonical())["bodies"][1]["spin"] == [0.0, 0.0, 1e-4]


def test_false_leaves_a_part_out_as_null_does_since_toml_has_no_null(tmp_path: Path):
    path = tmp_path / "scene.toml"
    path.write_text("""
        end_time = 10.0
        period = [4e5, false, false]
        bodies = [{size = [1e5, 1e5, 1e5], lattice = [4, 4, 4]}]
        [numerics]
        particles_per_cell = 1
        [physics]
        fracture = false
        gravity = false
        viscosity = false
        uniform_gravity = [0.0, 0.0, -1.0]
        [output]
        snapshot_interval = false
    """)
    parts = {"fracture": None, "gravity": None, "viscosity": None, "uniform_gravity": [0.0, 0.0, -1.0]}
    box = {"size": [1e5, 1e5, 1e5], "lattice": [4, 4, 4]}
    same = {"period": [4e5, None, None], "numerics": {"particles_per_cell": 1}, "output": {"snapshot_interval": None}}
    assert read_scene(path) == scene(bodies=[box], physics=parts, **same)
    assert read_scene(path).physics.gravity is None


def test_equal_scenes_have_equal_hashes_and_others_not():
    assert scene(end_time=100).hash() == scene(end_time=100.0).hash()
    assert scene(start_time=-0.0).hash() == scene(start_time=0.0).hash()
    assert scene(seed=1).hash() != scene(seed=2).hash()
    assert scene(end_time=10.000000001).hash() != scene(end_time=10.0).hash()


def test_scenes_are_frozen():
    with pytest.raises(ValueError, match="frozen"):
        scene().end_time = 5.0


def test_spacing_is_that_of_the_coarsest_body():
    coarse, fine = Sphere(radius=1e3, particles=10), Sphere(radius=1e3, particles=1000)
    two = Scene(bodies=(fine, coarse), end_time=1.0)
    assert two.spacing == pytest.approx((4.0 / 3.0 * np.pi * 1e9 / 10) ** (1 / 3))
    assert scene(numerics={"particles_per_cell": 8.0}).dx == pytest.approx(2.0 * scene().spacing)


@pytest.mark.parametrize("pull", [None, (0.0, 0.0, -1.0)])
def test_without_self_gravity_a_body_starts_without_pressure(pull: tuple[float, float, float] | None):
    floating = scene(physics={"gravity": None, "uniform_gravity": pull})
    assert floating.bodies[0].hydrostatic is False and not initial_state(floating)["tau"].any()
    assert scene().bodies[0].hydrostatic is True and initial_state(scene())["tau"].any()
    assert scene().hash() == scene(bodies=[{**BODY, "hydrostatic": True}]).hash()
    assert scene(bodies=[{**BODY, "hydrostatic": False}]).bodies[0].hydrostatic is False


def test_a_spinning_body_starts_as_a_rigid_rotation_in_hydrostatic_balance():
    spin, velocity = np.array([1e-4, -2e-4, 3e-4]), np.array([5.0, 0.0, -1.0])
    body = Sphere(radius=50e3, particles=2000, spin=tuple(spin), velocity=tuple(velocity), position=(1e6, 0.0, 0.0))
    state = initial_state(Scene(bodies=(body,), end_time=1.0))
    x = state["x"] - [1e6, 0.0, 0.0]
    np.testing.assert_allclose(state["v"], velocity + np.cross(spin, x), rtol=0, atol=1e-12)
    direction = np.array([0.3, -0.7, 0.2])
    np.testing.assert_allclose(state["C"] @ direction, np.tile(np.cross(spin, direction), (2000, 1)), atol=1e-18)
    pressure = 2.0 / 3.0 * np.pi * 6.6743e-11 * 2700.0**2 * np.maximum(50e3**2 - (x**2).sum(axis=1), 0.0)
    assert pressure.max() == pytest.approx(2.548e6, rel=0.01)
    np.testing.assert_allclose(-state["tau"][:, 0] / (1.0 + state["j"]), pressure, rtol=1e-12, atol=1.0)
    # the compression that bears it, to first order in a strain of 1e-4
    np.testing.assert_allclose(-2.67e10 * state["j"], pressure, rtol=4e-4)
    assert state["mass"].sum() == pytest.approx(body.mass, rel=1e-13)
