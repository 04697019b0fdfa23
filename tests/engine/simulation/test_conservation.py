"""Conserved quantities of states that are summed by hand."""

import numpy as np
import pytest

from engine.simulation.conservation import as_row
from engine.state.particles import Arrays
from tests.helpers.totals import elastic_energy, half_step_work, totals

SPIN = np.array([[0.0, -2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
"""Velocity gradient of a rotation by 2 rad/s about z."""


def pair() -> Arrays:
    """Particles of 3 and 1 kg on opposite sides of the origin; the first one turns."""
    return {
        "x": np.array([[1.0, 0.0, 0.0], [-3.0, 0.0, 0.0]]),
        "v": np.array([[0.0, 2.0, 0.0], [0.0, -4.0, 1.0]]),
        "C": np.array([SPIN, np.zeros((3, 3))]),
        "E": np.array([10.0, 20.0]),
        "mass": np.array([3.0, 1.0]),
        "transfer_heat": np.array([1.0, 2.0]),
        "plastic_heat": np.array([0.5, 0.0]),
        "viscous_heat": np.array([0.0, 4.0]),
        "affine_loss": np.array([2.0, 3.0]),
        "damage_root": np.array([1.0, 0.5]),
        "j": np.array([-1e-3, 1e-3]),
        "plastic_dilation": np.zeros(2),
    }


def test_totals_of_two_particles() -> None:
    """The affine part adds I w, with I per mass 1 m^2, about each axis of the gradient: here 2 (3 kg 1 m^2) 2 rad/s."""
    found = totals(pair(), inertia=1.0, elastic=np.array([1.0, 2.0]), gravitational_energy=-7.0, half_step_work=0.5)
    assert found.mass == 4.0
    assert found.momentum == pytest.approx([0.0, 2.0, 1.0])
    assert found.angular_momentum == pytest.approx([0.0, 3.0, 6.0 + 12.0 + 12.0])
    assert found.kinetic_energy == pytest.approx(0.5 * 3.0 * 4.0 + 0.5 * 17.0)
    assert found.affine_kinetic_energy == pytest.approx(0.5 * 3.0 * 8.0)
    assert (found.internal_energy, found.elastic_energy) == (50.0, 3.0)
    assert (found.transfer_heat, found.plastic_heat, found.viscous_heat) == (5.0, 1.5, 4.0)
    assert found.lost_energy == 9.0
    assert (found.damaged_fraction, found.compressed_fraction) == (0.5625, 0.75)
    assert found.total_energy == pytest.approx(14.5 + 12.0 + 0.5 + 50.0 - 7.0 + 9.0)


def test_heat_of_the_transfer_that_is_kept_out_of_internal_energy_is_lost_in_sight() -> None:
    found = totals(pair(), 1.0, np.zeros(2), 0.0, 0.0, takes_heat=False)
    assert found.lost_energy == 9.0 + 5.0


def test_a_row_has_the_totals_their_sum_and_what_is_added() -> None:
    found = totals(pair(), 1.0, np.zeros(2), 0.0, 0.0)
    row = as_row(found, time=5.0)
    assert row["total_energy"] == found.total_energy and row["time"] == 5.0
    assert row["momentum"].shape == (3,) and all(values.dtype == np.float64 for values in row.values())


def test_elastic_energy_is_that_of_small_strains() -> None:
    """Volume 2: P^2/2K of pressure alone, tau^2/2G of simple shear alone."""
    state = {
        "mass": np.full(2, 6.0),
        "j": np.zeros(2),
        "plastic_dilation": np.zeros(2),
        "tau": np.array([[-3.0, -3.0, -3.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 5.0, 0.0]]),
    }
    found = elastic_energy(state, rho0=np.full(2, 3.0), bulk=np.full(2, 10.0), shear=np.full(2, 4.0))
    assert found == pytest.approx([2.0 * 9.0 / 20.0, 2.0 * 25.0 / 8.0])


def test_half_a_step_does_the_work_of_gravity_less_that_of_stress() -> None:
    state = {
        "v": np.ones((5, 3)),
        "acceleration": np.full((5, 3), 2.0),
        "mass": np.arange(1.0, 6.0),
        "half_step_work": np.full(5, 0.7),
    }
    assert half_step_work(state, dt=0.4) == pytest.approx(15.0 * (0.2 * 6.0 - 0.7))
