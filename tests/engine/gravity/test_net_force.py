import numpy as np
import pytest
import taichi as ti

from engine.device.backend import place3, vec3
from engine.device.fields import allocate, capacity, overwrite
from engine.gravity.net_force import NetForce, RigidCorrection
from tests.helpers.device import Array, worst

pytestmark = pytest.mark.usefixtures("taichi")


def corrected(pull: Array, x: Array, mass: Array) -> tuple[Array, NetForce]:
    """What is left of accelerations, and what was removed."""
    count = len(x)
    fields = [allocate(kind, capacity(count)) for kind in (place3, ti.f64, place3, vec3)]
    for field, values in zip(fields, (x, mass, pull), strict=False):
        overwrite(field, values)
    removed = RigidCorrection(*fields, count).apply()
    return fields[3].to_numpy()[:count], removed


def cloud(count: int) -> tuple[Array, Array, Array]:
    """Pulls, positions and masses."""
    generator = np.random.default_rng(count)
    pull, x = generator.normal(size=(2, count, 3))
    return pull, 1e5 * x + 1e6, generator.uniform(1.0, 2.0, count)


def test_a_rigid_motion_is_taken_out_whole():
    _, x, mass = cloud(200)
    turning = np.cross([1.0, -2.0, 3.0], x - np.average(x, axis=0, weights=mass))
    rigid = turning + np.array([4e5, 5e5, 6e5])
    left, taken_out = corrected(rigid, x, mass)
    assert worst(left, np.zeros_like(left), np.abs(rigid).max()) < 1e-13
    assert 0.0 < taken_out.force < 1.0 and 0.0 < taken_out.torque < 1.0


def test_what_has_no_net_effect_stays_and_nothing_more_is_found_in_what_is_left():
    pull, x, mass = cloud(200)
    left, _ = corrected(pull, x, mass)
    again, taken_out = corrected(left, x, mass)
    assert worst(again, left, 1.0) < 1e-14
    assert taken_out.force < 1e-15 and taken_out.torque < 1e-15


def test_shares_of_a_common_push_and_of_a_pure_twist_are_one():
    x, mass = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), np.ones(2)
    _, push = corrected(np.tile([0.0, 3.0, 0.0], (2, 1)), x, mass)
    assert (push.force, push.torque) == (pytest.approx(1.0), pytest.approx(0.0, abs=1e-15))
    _, twist = corrected(np.array([[0.0, -3.0, 0.0], [0.0, 3.0, 0.0]]), x, mass)
    assert (twist.force, twist.torque) == (pytest.approx(0.0, abs=1e-15), pytest.approx(1.0))


def test_the_change_is_orthogonal_to_what_is_left():
    """So it is the smallest that does it, in the mass-weighted mean square."""
    pull, x, mass = cloud(50)
    left, _ = corrected(pull, x, mass)
    assert abs(np.sum(mass[:, None] * left * (pull - left))) < 1e-12 * np.sum(mass[:, None] * pull**2)


def test_one_particle_keeps_nothing_and_resting_ones_nothing_is_found_in():
    left, taken_out = corrected(np.ones((1, 3)), np.ones((1, 3)), np.ones(1))
    assert not left.any() and taken_out.torque == 0.0
    _, nothing = corrected(np.zeros((4, 3)), np.eye(4, 3), np.ones(4))
    assert (nothing.force, nothing.torque) == (0.0, 0.0)


def test_the_change_is_that_of_what_is_left():
    pull, x, mass = cloud(300)
    fields = [allocate(kind, 1024) for kind in (place3, ti.f64, place3, vec3)]
    correction = RigidCorrection(*fields, 300)
    left = []
    for factor in (1.0, 1.5):
        for field, values in zip(fields, (x, mass, factor * pull), strict=False):
            overwrite(field, values)
        change = correction.apply().change
        left.append(fields[3].to_numpy()[:300])
    assert change == pytest.approx(np.linalg.norm(left[1] - left[0]) / np.linalg.norm(left[1]), rel=1e-12)
    assert change == pytest.approx(1.0 / 3.0, rel=1e-12)
