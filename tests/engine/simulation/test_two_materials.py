"""Bodies of unlike matter, and turning ones, in a simulation."""

from typing import Any

import numpy as np
import pytest

from engine.scene.collision import Collision
from engine.simulation.simulation import Simulation
from tests.helpers.scenes import started

pytestmark = pytest.mark.usefixtures("taichi")

ICE = {"cohesion": 1e6, "intact_friction": 1.0, "melt_energy": 7e5, "friction": 0.6}
"""Guesses in place of what is not published."""


def simulation_of(particles: int, **settings: Any) -> Simulation:
    close = {"velocity": 500.0, "angle": 30.0, "particles": particles, "start_separation": 1.05}
    return started(Collision.model_validate({**close, **settings}).scene())


def test_ice_that_hits_basalt_is_compressed_more():
    simulation = simulation_of(200, projectile={"material": "ice"}, materials={"ice": ICE}, gravity=False)
    # spheres of particles are rough, and so touch a little early
    simulation.advance(0.0)
    state = simulation.particles.read("j", "body", "mass")
    basalt, ice = (-state["j"][state["body"] == body].min() for body in (0, 1))
    # one force compresses both; moduli differ by 2.8
    assert 0.01 < basalt < ice / 1.3 < basalt * 2.8 / 1.3
    volume = simulation.scene.bodies[0].spacing ** 3
    np.testing.assert_allclose(state["mass"], np.where(state["body"] == 0, 2700.0, 917.0) * volume, rtol=1e-12)


def test_the_spin_of_the_target_is_in_the_angular_momentum_of_the_run():
    turning = {"spin_period": 4.0, "spin_obliquity": 90.0}
    still, spun = (simulation_of(4000, target=target) for target in ({}, turning))
    body, dx = spun.scene.bodies[0], spun.scene.dx
    added = spun.totals().angular_momentum - still.totals().angular_momentum
    # m dx^2/2 of each particle's affine motion beside 2/5 M R^2
    expected = np.array(body.spin_momentum) * (1.0 + dx**2 / (0.8 * body.radius**2))
    np.testing.assert_allclose(added, expected, rtol=0.01, atol=0.01 * np.linalg.norm(expected))
