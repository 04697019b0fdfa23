"""Motion that any transfer keeps: linear flows, free flight, Hubble's law, momentum and angular momentum."""

import numpy as np
import pytest

from engine.simulation.initial_conditions import initial_state
from tests.helpers.device import Array, traceless, worst
from tests.helpers.scenes import advance, body, one_step, rubble_collision, scene, started

DUST = {"fracture": None, "gravity": None, "shear": False, "strength": False, "energy": False, "sound_speed": 1e-6}
"""So soft that its stress is round-off."""


def lengths(vectors: Array) -> Array:
    return np.asarray(np.sqrt((vectors**2).sum(axis=1)))


FLOWS = {
    "plane strain": np.diag([1e-3, -1e-3, 0.0]),
    "extension and two contractions": np.diag([2e-3, -1e-3, -1e-3]),
    "simple shear": np.array([[0.0, 1e-3, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
    "any potential flow": 1e-4 * (np.arange(9.0).reshape(3, 3) + np.arange(9.0).reshape(3, 3).T - 8.0),
}
"""Velocity gradients A [1/s] whose A^2 is symmetric."""


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("name", FLOWS)
def test_a_homogeneous_flow_stays_exact_up_to_the_surface(name):
    """v = v0 + A x without stress: particles fly straight, and the gradient becomes A (I + t A)^-1."""
    A, v0 = FLOWS[name], np.array([30.0, -200.0, 7.0])
    # the spin, which the flow replaces, tells the filter how fast matter moves
    turning = body(particles=300, position=(3e5, -2e5, 0.0), velocity=tuple(3.0 * v0), spin=(0.0, 0.0, 2e-3))
    given = scene(turning, physics=DUST)
    x = initial_state(given)["x"]
    simulation = started(given, v=v0 + x @ A.T, C=np.tile(A, (300, 1, 1)))
    while simulation.time < 200.0:
        simulation.advance(200.0)
    found = simulation.particles.read("x", "v", "C", "j")
    t = simulation.time
    F = np.eye(3) + t * A
    # the stress that is left changes velocities by 1e-11
    assert worst(found["v"], v0 + x @ A.T, 500.0) < 1e-10
    assert worst(found["x"], x + t * (v0 + x @ A.T), 50e3) < 1e-10
    assert worst(found["C"], np.tile(A @ np.linalg.inv(F), (300, 1, 1)), 500.0 / given.dx) < 1e-10
    assert worst(1.0 + found["j"], np.full(300, np.linalg.det(F)), 1.0) < 1e-10


@pytest.mark.usefixtures("taichi")
def test_any_linear_velocity_field_is_its_own_projection():
    """Translation, rotation and strain at once: nothing is left for the filter."""
    A, v0 = 1e-4 * np.random.default_rng(2).normal(size=(3, 3)), np.array([30.0, -200.0, 7.0])
    given = scene(body(particles=300, position=(3e5, -2e5, 0.0)), numerics={"cfl": 1e-9})
    x = initial_state(given)["x"]
    simulation = started(given, v=v0 + x @ A.T, C=np.tile(A, (300, 1, 1)))
    one_step(simulation)
    remainder = simulation.scheme.remainder
    assert np.abs(remainder.v.to_numpy()).max() < 1e-14 * 300.0
    assert np.abs(remainder.C.to_numpy()).max() < 1e-14 * 300.0 / given.dx


@pytest.mark.usefixtures("taichi")
def test_an_intact_body_flies_undisturbed():
    velocity = np.array([123.0, -45.0, 6.0])
    given = scene(body(particles=200, damage=0.0, velocity=tuple(velocity)))
    simulation = started(given)
    x = simulation.particles.read("x")["x"]
    advance(simulation, 150)
    found = simulation.particles.read("x", "v", "b_minus_I", "j")
    # every step adds round-off of 1e-16 v, which elasticity turns into waves of that size
    assert worst(found["v"], np.tile(velocity, (200, 1)), lengths(velocity[None])) < 1e-12
    assert worst(found["x"], x + simulation.time * velocity, given.dx) < 1e-11
    assert np.abs(found["b_minus_I"]).max() < 1e-13 and np.abs(found["j"]).max() < 1e-13


@pytest.mark.usefixtures("taichi")
def test_free_expansion_follows_hubbles_law():
    """v = H r from rest density: J = (1 + H t)^3 for every particle, no stress, straight paths."""
    H, count = 1e-3, 300
    given = scene(body(particles=count))
    x = initial_state(given)["x"]
    simulation = started(given, v=H * x, C=np.tile(H * np.eye(3), (count, 1, 1)))
    while simulation.time < 1.0 / H:
        simulation.advance(1.0 / H)
    growth = 1.0 + H * simulation.time
    found = simulation.particles.read("x", "v", "j", "tau", "E", "b_minus_I")
    assert growth >= 2.0
    assert worst(1.0 + found["j"], np.full(count, growth**3), growth**3) < 1e-12
    assert worst(found["x"], growth * x, 50e3) < 1e-12
    assert worst(found["v"], H * x, 50.0) < 1e-12
    assert not found["tau"].any() and np.abs(found["E"]).max() < 1e-12 * 50.0**2
    assert np.abs(traceless(found["b_minus_I"][:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]])).max() < 1e-12


@pytest.mark.usefixtures("taichi")
def test_a_rubble_collision_keeps_momentum_and_angular_momentum():
    simulation = started(rubble_collision(numerics={"cfl": 0.2}))
    before = simulation.totals()
    state = simulation.particles.read("x", "v", "mass")
    linear = (state["mass"] * lengths(state["v"])).sum()
    angular = (state["mass"] * lengths(state["x"]) * lengths(state["v"])).sum()
    after = advance(simulation, 750).totals()
    assert after.kinetic_energy < 0.95 * before.kinetic_energy, "they did collide"
    # round-off of 750 steps
    assert np.abs(after.momentum - before.momentum).max() < 1e-14 * linear
    assert np.abs(after.angular_momentum - before.angular_momentum).max() < 1e-14 * angular
    assert after.mass == before.mass
    change = after.total_energy - before.total_energy
    assert abs(change) < 1e-3 * before.kinetic_energy
    assert after.transfer_heat > 10.0 * abs(change), "what the transfer took is in the account"
