"""Friends-of-friends and the bound mass, on cases small enough for paper."""

import numpy as np
import pytest

from analysis.remnant.fragments import Clumps, as_points, bound_to_largest, friends_of_friends
from engine.constants import G_NEWTON

LINE = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0], [5.0, 0, 0]])


def test_four_points_of_which_three_are_friends() -> None:
    assert friends_of_friends(LINE, np.ones(4), 1.2).tolist() == [0, 0, 0, 1]
    assert friends_of_friends(LINE, np.ones(4), 0.9).tolist() == [0, 1, 2, 3]
    assert friends_of_friends(LINE, np.ones(4), 3.0).tolist() == [0, 0, 0, 0]


def test_labels_go_by_mass_and_equal_masses_by_their_first_particle() -> None:
    position = np.array([[9.0, 0, 0], [0.0, 0, 0], [9.5, 0, 0], [0.5, 0, 0], [5.0, 0, 0]])
    assert friends_of_friends(position, np.ones(5), 1.0).tolist() == [0, 1, 0, 1, 2]
    assert friends_of_friends(position, np.array([1.0, 1.0, 1.0, 1.0, 9.0]), 1.0).tolist() == [1, 2, 1, 2, 0]


def test_velocity_plays_no_part_and_one_particle_is_a_clump() -> None:
    assert friends_of_friends(np.zeros((1, 3)), np.ones(1), 1.0).tolist() == [0]


def test_clumps_as_points_have_the_mean_position_and_velocity() -> None:
    mass = np.array([1.0, 3.0, 2.0, 5.0])
    velocity = np.array([[4.0, 0, 0], [0.0, 4.0, 0], [0.0, 0, 1.0], [7.0, 7.0, 7.0]])
    clumps = as_points(np.array([0, 0, 1, 1]), mass, LINE, velocity)
    np.testing.assert_allclose(clumps.mass, [4.0, 7.0])
    np.testing.assert_allclose(clumps.position, [[0.75, 0, 0], [29.0 / 7.0, 0, 0]])
    np.testing.assert_allclose(clumps.velocity, [[1.0, 3.0, 0.0], [5.0, 5.0, 37.0 / 7.0]])


def escape_speed(mass: float, distance: float) -> float:
    return float(np.sqrt(2.0 * G_NEWTON * mass / distance))


@pytest.mark.parametrize(("share", "bound"), [(0.999, True), (1.001, False)])
def test_a_clump_is_bound_below_the_mutual_escape_speed(share: float, bound: bool) -> None:
    mass, distance = np.array([1.4e18, 0.3e18]), 2.0e5
    speed = share * escape_speed(mass.sum(), distance)
    clumps = Clumps(mass, np.array([[0.0, 0, 0], [distance, 0, 0]]), np.array([[0.0, 0, 0], [0.6, 0.8, 0]]) * speed)
    assert bound_to_largest(clumps).tolist() == [True, bound]


def test_a_clump_can_be_bound_only_once_another_has_joined() -> None:
    mass, far = np.array([1.0e18, 1.0e18, 1.0e6]), 1.0e6
    position = np.array([[-5.0e3, 0, 0], [5.0e3, 0, 0], [0.0, far, 0]])
    velocity = np.array([[0.0, 0, 0], [0.0, 0, 0], [0.0, 1.2 * escape_speed(1.0e18, far), 0]])
    assert bound_to_largest(Clumps(mass, position, velocity)).tolist() == [True, True, True]
    without = [0, 2]
    alone = Clumps(mass[without], position[without], velocity[without])
    assert bound_to_largest(alone).tolist() == [True, False]


def test_bound_mass_does_not_depend_on_where_and_how_fast_the_whole_moves() -> None:
    random = np.random.default_rng(5)
    mass = np.sort(random.uniform(1e16, 1e18, 30))[::-1]
    position = random.normal(0.0, 3e5, (30, 3))
    velocity = random.normal(0.0, 1.0, (30, 3)) * np.linspace(1.0, 100.0, 30)[:, None]
    bound = bound_to_largest(Clumps(mass, position, velocity))
    assert 1 < bound.sum() < 30
    moved = Clumps(mass, position + 1e6, velocity - 300.0)
    assert bound_to_largest(moved).tolist() == bound.tolist()
