import numpy as np
import pytest
import taichi as ti

from engine.laws.damage import Damage
from engine.laws.fracture import Unbreakable
from engine.profile.parts import parts_of
from engine.state.particles import Particles
from tests.helpers.device import evaluate, moved
from tests.helpers.scenes import advance, body, scene, started

pytestmark = pytest.mark.usefixtures("taichi")


def test_damage_is_the_cube_of_its_root() -> None:
    particles = Particles(100)
    law, D = Damage(particles, Unbreakable()), np.linspace(0.0, 1.0, 100)
    particles.write({"damage_root": np.cbrt(D)})
    (found,) = evaluate(law.value, np.arange(100, dtype=np.int32))
    np.testing.assert_allclose(found, D, rtol=1e-15)


@ti.data_oriented
class ByNumber:
    """Growth that gives each particle its number in the scene as root."""

    @ti.func
    def grow(self, root, s, P, dt, p, body):
        return float(p)


@ti.data_oriented
class Step:
    """A step of damage alone, for every index on the device."""

    def __init__(self, law: Damage) -> None:
        self.law = law

    @ti.kernel
    def take(self, count: ti.i32):
        for p in range(count):
            self.law.grow(p, ti.Matrix.zero(float, 3, 3), 0.0, 1.0, 0)


def test_growth_knows_particles_by_their_number_in_the_scene() -> None:
    """The flaws of a particle are its own wherever it lies on the device."""
    particles = Particles(20)
    law = Damage(particles, ByNumber())
    moved(particles, np.random.default_rng(1))
    Step(law).take(20)
    assert np.array_equal(particles.read("damage_root")["damage_root"], np.arange(20))


def test_damage_that_only_stays_is_kept_without_flaws():
    simulation = advance(started(scene(body(damage=0.3))), 2)
    np.testing.assert_allclose(simulation.particles.read("damage_root")["damage_root"] ** 3, 0.3, rtol=1e-14)
    assert "fracture" not in {part.name for part in parts_of(simulation) if part.fields}
