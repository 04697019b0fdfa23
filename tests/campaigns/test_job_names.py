"""Names of jobs."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from campaigns.job_names import LONGEST, alias, belongs_to, job_id
from engine.scene.collision import Collision

SAFE = re.compile(r"[A-Za-z0-9._-]+")
HASH = "0123456789abcdef"


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ({"velocity": 200.0, "angle": 15.0}, "v0200_a15"),
        ({"velocity": 200, "angle": 5}, "v0200_a05"),
        ({"velocity": 62.5, "angle": 7.25}, "v0062.5_a07.25"),
        ({"velocity": 12000.0, "seed": 3}, "v12000_seed3"),
        ({"viscosity.shear": 1e5}, "viscosity.shear100000"),
        ({"materials.basalt.weibull_k": 4e35}, "materials.basalt.weibull_k4e35"),
        ({"parameter_set": "talk"}, "parameter_set-talk"),
        ({"fracture.per_flaw": True}, "fracture.per_flaw-true"),
        ({}, "base"),
    ],
)
def test_alias(values, name):
    assert alias(values) == name


def test_job_id_ends_with_the_hash():
    assert job_id("v0200_a15", HASH) == "v0200_a15-01234567"


def test_long_alias_is_cut():
    name = job_id("x" * 500, HASH)
    assert len(name) == LONGEST + 9


@settings(max_examples=50, deadline=None)
@given(st.text(min_size=1))
def test_any_text_gives_a_safe_name(text):
    assert SAFE.fullmatch(job_id(alias({"parameter_set": text}), HASH))


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), unique=True, min_size=2, max_size=2))
def test_different_numbers_have_different_names(numbers):
    first, second = (alias({"friction": number}) for number in numbers)
    assert first != second


def test_scene_belongs_to_its_job_only():
    scene = Collision(velocity=100, angle=5).scene()
    name = job_id("any", scene.hash())
    assert belongs_to(name, scene.canonical().encode())
    assert not belongs_to(name, scene.canonical().encode() + b" ")
