"""Dotted keys of input models."""

from collections.abc import Iterator

import pytest
from pydantic import BaseModel

from engine.scene.collision import Collision
from engine.scene.keys import current_key, meaning_of, models_in, unit_of
from engine.scene.scene import Scene

OLD = {
    "radius": "target.radius",
    "projectile_radius": "projectile.radius",
    "friction": "materials.basalt.friction",
    "material": "materials.basalt",
    "material.rho0": "materials.basalt.rho0",
    "material.damaged_friction": "materials.basalt.friction",
    "material.tillotson.A": "materials.basalt.eos.A",
    "materials.ice.tillotson.E0": "materials.ice.eos.E0",
}


def test_an_old_key_leads_to_the_new_one_however_deep():
    assert {key: current_key(Collision, key) for key in OLD} == OLD
    assert current_key(Scene, "bodies.1.material.damaged_friction") == "bodies.1.material.friction"


@pytest.mark.parametrize("key", ["velocity", "target.radius", "materials.basalt.friction", "frction", "radius2"])
def test_any_other_key_was_not_renamed(key):
    assert current_key(Collision, key) is None


def test_new_keys_exist():
    assert all(meaning_of(Collision, key) for key in OLD.values() if key != "materials.basalt")


@pytest.mark.parametrize(
    ("key", "unit"),
    [
        ("velocity", "m s-1"),
        ("target.spin_period", "hour"),
        ("projectile.radius", "m"),
        ("materials.ice.rho0", "kg m-3"),
        ("materials.basalt.eos.E_iv", "J kg-1"),
        ("materials.basalt.eos.K", "Pa"),
        ("viscosity.shear", "m2 s-1"),
        ("parameter_set", ""),
        ("materials.basalt.friction", "1"),
        ("velocty", None),
        ("materials.rho0", None),
    ],
)
def test_units_of_keys(key, unit):
    assert unit_of(Collision, key) == unit


def models(model: type[BaseModel], seen: set[type[BaseModel]]) -> Iterator[type[BaseModel]]:
    """The model and all inside it, each once."""
    if model not in seen:
        seen.add(model)
        yield model
        for field in model.model_fields.values():
            for inner in models_in(field.annotation):
                yield from models(inner, seen)


@pytest.mark.parametrize("root", [Collision, Scene])
def test_every_key_says_what_it_is_and_every_number_its_unit(root):
    for model in models(root, set()):
        for name, field in model.model_fields.items():
            assert field.description, f"{model.__name__}.{name}"
            is_number = any(word in str(field.annotation) for word in ("float", "int"))
            assert bool(field.json_schema_extra["unit"]) == is_number, f"{model.__name__}.{name}"
