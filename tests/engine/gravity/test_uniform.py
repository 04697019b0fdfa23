"""Uniform gravity, and none."""

import numpy as np
import pytest

from engine.gravity.uniform import NoGravity, UniformGravity
from engine.profile.parts import allocated_bytes
from engine.state.particles import CORE_FIELDS
from tests.helpers.device import evaluate
from tests.helpers.scenes import advance, body, scene, started

pytestmark = pytest.mark.usefixtures("taichi")

BARE = {"energy": False, "shear": False, "strength": False, "fracture": None, "gravity": None}


def test_every_particle_has_the_same_acceleration_and_energy_falls_along_it() -> None:
    g = np.array([1.0, -2.0, 3.0])
    gravity, generator = UniformGravity((1.0, -2.0, 3.0)), np.random.default_rng(1)
    moment, mass = generator.normal(size=3), 45.0
    (found,) = evaluate(gravity.at, np.arange(30, dtype=np.int32), outputs=((3,),))
    assert np.array_equal(found, np.tile(g, (30, 1)))
    lifted = moment + mass * np.array([0.5, 0.5, 0.5])
    assert gravity.energy(lifted) - gravity.energy(moment) == pytest.approx(-mass, rel=1e-12)


def test_no_gravity_does_nothing() -> None:
    (found,) = evaluate(NoGravity().at, np.arange(3, dtype=np.int32), outputs=((3,),))
    assert not found.any() and NoGravity().energy(np.ones(3)) == 0.0


def test_uniform_gravity_needs_no_field_of_particles():
    g = (1.0, -2.0, 3.0)
    simulation = advance(started(scene(body(), physics={**BARE, "uniform_gravity": g})), 20)
    before = started(scene(body(), physics=BARE)).particles.read("x")["x"]
    assert set(simulation.particles.allocated) - set(CORE_FIELDS) == {"damage_root"}
    assert allocated_bytes(simulation.gravity.acceleration) == 24
    state, t = simulation.particles.read("x", "v", "mass"), simulation.time
    # velocities belong to the middle of the step
    middle = t - 0.5 * float(simulation.clock.dt[None])
    np.testing.assert_allclose(state["v"], np.tile(np.multiply(g, middle), (100, 1)), rtol=1e-11)
    fallen = (state["x"] - before).mean(axis=0)
    np.testing.assert_allclose(fallen, np.multiply(g, 0.5 * t**2), rtol=1e-4)
    assert simulation.totals().gravitational_energy == pytest.approx(
        -float((state["mass"] * (state["x"] @ g)).sum()), rel=1e-13
    )
