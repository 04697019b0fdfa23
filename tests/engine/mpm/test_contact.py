"""Bodies touch where their surfaces meet, and not before."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from engine.mpm.contact import depth_of
from engine.scene.bodies import Box
from engine.scene.scene import Numerics, Physics, Scene
from engine.simulation.initial_conditions import initial_state
from engine.simulation.simulation import Simulation
from engine.verification.problems.materials import elastic
from tests.helpers.device import Array, worst
from tests.helpers.scenes import advance, rubble_collision, spline, started

pytestmark = pytest.mark.usefixtures("taichi")

ACROSS = 4.0
"""Width of slabs [m]; cells are 1 m wide."""
ELASTIC = {"fracture": None, "gravity": None, "strength": False}


SOFT = elastic(rho0=2700.0, bulk=2.4e6, shear=1.4e6)
"""Longitudinal waves travel at 40 m/s."""


def slab(left: float, right: float, per_cell: int = 4, **changes: object) -> Box:
    """Matter between two planes [m], of regular particles."""
    length = right - left
    lattice = (round(length * per_cell), round(ACROSS * per_cell), round(ACROSS * per_cell))
    position = (0.5 * (left + right), 0.5 * ACROSS, 0.5 * ACROSS)
    return Box.model_validate(
        {
            "size": (length, ACROSS, ACROSS),
            "lattice": lattice,
            "position": position,
            "damage": 1.0,
            "material": SOFT,
            **changes,
        }
    )


def slabs(*bodies: Box, end_time: float = 1.0, per_cell: int = 4, **physics: object) -> Scene:
    """Slabs, periodic across."""
    return Scene(
        bodies=bodies,
        period=(None, ACROSS, ACROSS),
        end_time=end_time,
        physics=Physics.model_validate({**ELASTIC, **physics}),
        numerics=Numerics(particles_per_cell=float(per_cell**3)),
    )


def finished(simulation: Simulation) -> Simulation:
    while not simulation.finished:
        simulation.advance(simulation.scene.end_time)
    return simulation


@pytest.mark.parametrize("offset", [0.0, 0.31])
@pytest.mark.parametrize("gap", [0.0, 0.25, 1.0])
def test_slabs_touch_when_their_surfaces_are_as_near_as_asked(gap, offset):
    """Wherever they meet between nodes."""
    speed, start = 1.0, 2.0
    left = slab(-4.0 - 0.5 * start + offset, -0.5 * start + offset, velocity=(0.5 * speed, 0.0, 0.0))
    right = slab(0.5 * start + offset, 4.0 + 0.5 * start + offset, velocity=(-0.5 * speed, 0.0, 0.0))
    simulation = finished(started(slabs(left, right, end_time=1.1 * start / speed, contact={"gap": gap})))
    assert abs(start - speed * simulation.clock.contact_time[None] - gap) < 0.03


def test_the_depth_of_a_node_is_that_of_the_half_space_that_fills_it():
    depth = np.array([-1.5, -1.4, -0.8, -0.5, -0.2, 0.0, 0.3, 0.5, 0.9, 1.5])
    filled = np.array([quad(spline, -1.5, d, points=[-0.5, 0.5])[0] for d in depth])
    np.testing.assert_allclose(depth_of(filled), depth, atol=1e-5)


def test_bodies_fly_freely_until_they_touch():
    """And do not where nodes are shared."""
    left = slab(-5.0, -1.0, velocity=(2.0, 0.0, 0.0), per_cell=2)
    right = slab(1.0, 5.0, velocity=(-2.0, 0.0, 0.0), per_cell=2)
    fate = {}
    for contact in ({}, False):
        simulation = finished(started(slabs(left, right, end_time=0.35, per_cell=2, contact=contact)))
        fate[bool(contact is not False)] = float(np.abs(np.abs(simulation.particles.read("v")["v"][:, 0]) - 2.0).max())
        assert np.isinf(simulation.clock.contact_time[None])
    assert fate[True] < 1e-12
    assert fate[False] > 0.4


def rebound(contact: object) -> tuple[Array, Array]:
    """Velocity [m/s] of two elastic slabs after they have bounced, and how far both have gone astray [cells].

    Equal slabs exchange their velocities: they touch for 2L/c, and go on as if they had passed through each other.
    """
    speed, gap, length = 0.1, 1.5, 4.0
    left = slab(-length - 0.4, -0.4, per_cell=2, velocity=(speed, 0.0, 0.0))
    right = slab(gap - 0.4, length + gap - 0.4, per_cell=2, velocity=(-speed, 0.0, 0.0))
    state = finished(started(slabs(left, right, end_time=2.0 * gap / speed, per_cell=2, contact=contact)))
    found = state.particles.read("x", "v", "body")
    v, x = (np.array([found[name][found["body"] == body, 0].mean() for body in (0, 1)]) for name in ("v", "x"))
    start = np.array([left.position[0], right.position[0]])
    exact = start + speed * state.scene.end_time * np.array([-1.0, 1.0]) + gap * np.array([1.0, -1.0])
    return v, np.abs(x - exact)


def test_elastic_slabs_rebound_where_their_surfaces_meet():
    """Where nodes are shared they hang together across the gap."""
    v, astray = rebound({})
    assert np.abs(v - [-0.1, 0.1]).max() < 0.015
    assert astray.max() < 0.3
    assert rebound(False)[1].min() > 0.6


def split(at: tuple[float, ...]) -> Scene:
    """A slab of 8 cells as one body, or cut into several."""
    edges = (0.0, *at, 8.0)
    bodies = [slab(left, right, per_cell=2) for left, right in pairwise(edges)]
    return slabs(*bodies, per_cell=2)


def wave(x: Array) -> Array:
    """A pulse of compression, in the middle of 8 cells [m/s]."""
    v = np.zeros_like(x)
    v[:, 0] = -2.0 * (x[:, 0] - 4.0) * np.exp(-((x[:, 0] - 4.0) ** 2))
    return v


@pytest.mark.parametrize("at", [(4.0,), (2.0, 4.0, 5.5)])
def test_a_wave_passes_a_contact_as_if_there_were_none(at):
    """Cut surfaces that stay pressed together change nothing but the order of sums."""
    found = {}
    for cut in ((), at):
        scene = split(cut)
        x = initial_state(scene)["x"]
        simulation = advance(started(scene, v=wave(x)), 12)
        order = np.lexsort(x.T)
        found[cut] = {name: field[order] for name, field in simulation.particles.read("x", "v", "tau").items()}
    scale = {"x": 1.0, "v": 1.0, "tau": np.abs(found[()]["tau"]).max()}
    for name, size in scale.items():
        assert worst(found[at][name], found[()][name], size) < 1e-11


def test_contact_changes_no_bit_of_one_body():
    one, other = (advance(started(slabs(slab(0.0, 4.0, 2), per_cell=2, contact=contact)), 5) for contact in ({}, False))
    for name, field in one.particles.read().items():
        assert np.array_equal(field, other.particles.read()[name])


def test_momentum_and_angular_momentum_stay_through_a_contact():
    simulation = started(rubble_collision())
    before = simulation.totals()
    while np.isinf(simulation.clock.contact_time[None]):
        simulation.advance(simulation.scene.end_time)
    after = advance(simulation, simulation.step + 100).totals()
    scale = float(np.sum(simulation.particles.read("mass")["mass"]))
    assert np.abs(after.momentum - before.momentum).max() < 1e-12 * 200.0 * scale
    assert np.abs(after.angular_momentum - before.angular_momentum).max() < 1e-12 * np.linalg.norm(
        before.angular_momentum
    )


def test_a_wave_passes_an_edge_at_which_four_bodies_meet():
    """No two of them fill the nodes there. (Where a wave dilates matter by more than 0.3 %, its fringes part.)"""
    quarters = [
        Box(
            size=(4.0, 4.0, ACROSS),
            lattice=(8, 8, 8),
            position=(2.0 + 4.0 * i, 2.0 + 4.0 * j, 0.5 * ACROSS),
            damage=1.0,
            material=SOFT,
        )
        for i in (0, 1)
        for j in (0, 1)
    ]
    whole = Box(size=(8.0, 8.0, ACROSS), lattice=(16, 16, 8), position=(4.0, 4.0, 2.0), damage=1.0, material=SOFT)
    found = []
    for bodies in ([whole], quarters):
        given = {"period": (8.0, 8.0, ACROSS), "end_time": 1.0, "physics": ELASTIC}
        scene = Scene.model_validate({"bodies": bodies, "numerics": {"particles_per_cell": 8.0}, **given})
        x = initial_state(scene)["x"]
        v = 1e-3 * (wave(x) + wave(x[:, [1, 0, 2]])[:, [1, 0, 2]])
        simulation = advance(started(scene, v=v), 12)
        found.append(simulation.particles.read("v")["v"][np.lexsort(np.round(x, 9).T)])
    assert np.abs(found[0]).max() > 1e-4
    assert worst(found[1], found[0], 1e-3) < 1e-11
