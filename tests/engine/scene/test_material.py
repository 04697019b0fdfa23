"""Materials by name, and what a scene asks of them."""

from typing import Any

import pytest

from engine.errors import SceneError
from engine.scene.fields import validate
from engine.scene.material import Material, named
from engine.scene.materials import CONSTANTS
from engine.scene.scene import Scene

BODY: dict[str, Any] = {"radius": 1e3, "particles": 10}
MISSING_OF_ICE = {"cohesion": 1e6, "intact_friction": 1.0, "melt_energy": 7e5, "friction": 0.6}
"""Guesses in place of what is not published."""
FLUID = {"shear": False, "strength": False, "fracture": False}


def scene(material: Any, **physics: Any) -> Scene:
    table = {"bodies": [BODY, {**BODY, "material": material}], "end_time": 1.0, "physics": physics}
    return validate(Scene, table, "scene.toml")


def test_basalt_is_that_of_sugiura_2018():
    basalt = named("basalt")
    assert (basalt.rho0, basalt.shear_modulus, basalt.eos.bulk_modulus()) == (2700.0, 2.27e10, 2.67e10)
    assert (basalt.cohesion, basalt.intact_friction, basalt.strength_limit) == (1e7, 1.0, 3.5e9)
    assert (basalt.melt_energy, basalt.friction, basalt.weibull_k, basalt.weibull_m) == (3.4e6, 0.839, 4e35, 9.0)


def test_ice_carries_sound_at_the_speed_of_ice_and_has_no_constant_of_basalt():
    ice = named("ice")
    # longitudinal waves in polycrystalline ice Ih travel at 3.8 to 3.9 km/s
    assert ice.longitudinal_speed == pytest.approx(3800.0, rel=0.03)
    assert [key for key in MISSING_OF_ICE if getattr(ice, key) is not None] == []


@pytest.mark.parametrize("name", CONSTANTS)
def test_a_name_alone_a_name_in_a_table_and_all_constants_are_the_same_material(name):
    by_name, in_table = Material.model_validate(name), Material.model_validate({"name": name})
    assert by_name == in_table == named(name) == Material.model_validate(by_name.model_dump())


def test_a_table_with_a_name_is_laid_over_the_shipped_one():
    changed = Material.model_validate({"name": "ice", "friction": 0.4, "eos": {"A": 1e9}})
    assert (changed.friction, changed.eos.bulk_modulus(), changed.rho0) == (0.4, 1e9, 917.0)
    assert changed.eos.vaporisation_energy() == named("ice").eos.vaporisation_energy()


def test_a_body_without_material_is_basalt_and_the_scene_has_its_constants_written():
    given = scene("ice", **FLUID)
    first, second = (body["material"] for body in given.model_dump()["bodies"])
    assert (first["name"], first["rho0"]) == ("basalt", 2700.0)
    assert (second["name"], second["eos"]["E0"], second["friction"]) == ("ice", 1e7, None)
    assert Scene.model_validate_json(given.canonical()) == given


@pytest.mark.parametrize(
    ("material", "told"),
    [
        ("icee", ["'bodies.1.material'", "unknown material 'icee'", "did you mean 'ice'"]),
        ({"name": "chalk", "rho0": 1.0}, ["unknown material 'chalk'", "must give eos, shear_modulus"]),
        ({"friction": 0.5}, ["'bodies.1.material'", "without 'name'", "rho0, eos, shear_modulus", "basalt, ice"]),
        ({"name": "basalt", "damaged_friction": 0.5}, ["'bodies.1.material.damaged_friction' is now", ".friction'"]),
        ({"name": "ice", "frictoin": 0.5}, ["unknown key 'bodies.1.material.frictoin'", "did you mean 'friction'"]),
        ({"name": "ice", "eos": {"A": -1.0}}, ["'bodies.1.material.eos.A'", "greater than 0", "-1.0"]),
        ({"damaged_friction": 0.5}, ["'bodies.1.material.damaged_friction' is now", ".friction'"]),
        ({"rho0": 1.0, "shear_modulus": 1.0, "tillotson": {}}, ["'bodies.1.material.tillotson' is now", ".eos'"]),
        ({"name": 3}, ["'bodies.1.material'", "'name' must be text (given 3)"]),
        (3, ["'bodies.1.material'", "table of keys", "3"]),
    ],
)
def test_a_wrong_material_is_named_with_the_way_out(material, told):
    with pytest.raises(SceneError) as error:
        scene(material)
    assert all(words in str(error.value) for words in told), str(error.value)
    assert "\n" not in str(error.value)


def test_what_the_physics_of_a_scene_needs_is_asked_for():
    with pytest.raises(SceneError) as error:
        scene("ice")
    missing = ", ".join(MISSING_OF_ICE)
    assert f"'bodies.1.material' (ice) lacks {missing}, which 'physics.strength' needs" in str(error.value)
    assert "physics.strength = false" in str(error.value)
    bare = {"rho0": 900.0, "shear_modulus": 1e9, "eos": CONSTANTS["ice"]["eos"], "strength_limit": 1e9}
    with pytest.raises(SceneError, match=r"\(without name\) lacks weibull_k, weibull_m, which 'physics.fracture'"):
        scene({**bare, **MISSING_OF_ICE})
    for given, physics in (
        ({"name": "ice", **MISSING_OF_ICE}, {}),
        ({**bare, **MISSING_OF_ICE}, {"fracture": False}),
        ("ice", {"strength": False, "fracture": False}),
        (bare, FLUID),
    ):
        assert scene(given, **physics).materials[1].rho0 in (917.0, 900.0)


def test_a_constant_that_is_unknown_is_never_a_number():
    assert named("basalt").known("friction") == 0.839
    with pytest.raises(ValueError, match="material ice has no 'cohesion'"):
        named("ice").known("cohesion")


PACKING = {"critical_density": 2000.0, "dilatancy": 0.1, "crushing_pressure": 1e7}


def test_rock_that_does_not_loosen_writes_no_packing_so_that_older_scenes_keep_their_hash():
    plain, loosening = named("basalt", friction=0.9), named("basalt", friction=0.9, **PACKING)
    assert not PACKING.keys() & plain.model_dump().keys() and PACKING.keys() <= loosening.model_dump().keys()
    assert plain.hash() != loosening.hash()
    for material in (plain, loosening):
        assert Material.model_validate(material.model_dump(mode="json")) == material
