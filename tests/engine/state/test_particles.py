"""State of the particles: what has a field, and in which order it is read."""

import numpy as np
import pytest

from engine.state.particles import CORE_FIELDS, FIELD_TYPES, Particles
from tests.helpers.device import moved

pytestmark = pytest.mark.usefixtures("taichi")


def test_arrays_keep_the_order_of_the_scene_however_particles_lie_on_the_device() -> None:
    generator = np.random.default_rng(1)
    particles, x = Particles(50), generator.normal(size=(50, 3))
    C = generator.normal(size=(50, 3, 3))
    particles.write({"x": x, "C": C, "body": np.arange(50, dtype=np.int32)})
    for _ in range(3):
        order = moved(particles, generator)
        assert np.array_equal(particles.x.to_numpy()[:50], x[order])
        assert np.array_equal(particles.index.to_numpy()[:50], order)
        state = particles.read("x", "C", "body")
        assert np.array_equal(state["C"], C)
        assert np.array_equal(state["x"], x) and np.array_equal(state["body"], np.arange(50))
    x = generator.normal(size=(50, 3))
    particles.write({"x": x})
    assert np.array_equal(particles.read("x")["x"], x)
    assert np.array_equal(particles.x.to_numpy()[:50], x[order])


def test_bodies_are_listed_one_after_another() -> None:
    particles = Particles(5)
    particles.write({"body": np.array([1, 0, 2, 0, 1])})
    assert np.array_equal(particles.listed.to_numpy()[:5], [1, 3, 0, 4, 2])


def test_copies_are_read_in_double_precision() -> None:
    particles = Particles(4)
    state = particles.read()
    assert {values.dtype.name for values in state.values()} == {"float64", "int32"}
    state["x"][:] = 1.0
    assert not particles.read("x")["x"].any()


def test_a_field_is_allocated_once() -> None:
    particles = Particles(3)
    assert particles.require("E") is particles.require("E")
    assert particles.allocated == (*CORE_FIELDS, "E")


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
