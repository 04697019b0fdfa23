"""Bounds that follow from a scene."""

import numpy as np
import pytest

from engine.constants import G_NEWTON
from engine.scene.material import named
from engine.simulation.bounds import (
    compression_limit,
    energy_growth,
    keeps_energy,
    keeps_momentum,
    largest_energy_change,
    momentum_drift,
    speed_of_motion,
)
from engine.simulation.conservation import Row
from tests.helpers.scenes import body, scene

PULLED = {"fracture": None, "gravity": None, "uniform_gravity": (0.0, 0.0, -1.0)}


def row(**energies: float) -> Row:
    names = ("kinetic_energy", "affine_kinetic_energy", "internal_energy", "elastic_energy", "gravitational_energy")
    parts = {name: energies.get(name, 0.0) for name in names}
    total = sum(value for name, value in parts.items() if name != "elastic_energy")
    values = {**parts, "total_energy": total, "mass": 1.0}
    return {name: np.asarray(value) for name, value in values.items()}


def test_the_bound_of_compression_uses_the_energy_up_and_soft_matter_has_none() -> None:
    basalt, soft = named("basalt"), named("basalt", eos={"A": 1.0, "B": 0.0})
    assert basalt.eos.cold_energy(2700.0, compression_limit(basalt, 5e6)) == pytest.approx(5e6)
    assert compression_limit(soft, 5e6) == np.inf


def test_growth_of_energy_is_measured_in_all_energies() -> None:
    given, start = scene(body()), row(kinetic_energy=6e20, internal_energy=-4e20)
    assert energy_growth(given, row(kinetic_energy=7e20, internal_energy=-4e20), start) == pytest.approx(0.1)


def test_a_scene_at_rest_measures_its_growth_in_the_round_off_of_sound() -> None:
    given = scene(body())
    scale = np.finfo(np.float64).eps * given.materials[0].longitudinal_speed ** 2
    assert energy_growth(given, row(kinetic_energy=scale), row()) == pytest.approx(1.0)


def test_energy_may_change_by_the_square_of_the_size_of_cells() -> None:
    """(dx/R)^2/15 of the smallest body, 1e-3 where bodies are well resolved, and cfl^2 where one is a particle."""
    big, small = body(radius=50e3, particles=4000), body(radius=5e3, particles=500, position=(1e5, 0.0, 0.0))
    given = scene(big, small)
    assert largest_energy_change(given) == pytest.approx((given.dx / 50e3) ** 2 * 4.0 / 15.0, rel=1e-12)
    fast = body(particles=100_000, velocity=(0.0, 10e3, 0.0)), body(particles=100_000, position=(2e5, 0.0, 0.0))
    assert largest_energy_change(scene(fast[1])) == 1e-3
    jet = body(particles=100_000, velocity=(0.0, 1e6, 0.0))
    assert largest_energy_change(scene(jet, fast[1])) == 2e-2
    assert largest_energy_change(scene(*fast)) == pytest.approx(1e-3 + 10.0 / named("basalt").longitudinal_speed)
    pairs = [scene(big, body(particles=count, position=(1e5, 0.0, 0.0))) for count in (1, 2)]
    allowed = [largest_energy_change(pair) for pair in pairs]
    np.testing.assert_allclose(allowed, [0.6**2, (4.0 / 3.0 * np.pi) ** (2.0 / 3.0) / 15.0])


def test_the_speed_of_motion_is_that_at_which_bodies_meet() -> None:
    """Twice the fastest body and its rotation in the frame of all mass, and the speed of escape from all mass."""
    left = body(velocity=(100.0, 50.0, 0.0), spin=(0.0, 0.0, 1e-3))
    right = body(velocity=(-100.0, 50.0, 0.0), position=(2e5, 0.0, 0.0))
    assert speed_of_motion(scene(body(velocity=(100.0, 0.0, 0.0)))) == 0.0
    assert speed_of_motion(scene(left, right)) == pytest.approx(2.0 * (100.0 + 50.0), rel=1e-12)
    heavy = scene(left, right, physics={"fracture": None, "gravity": {}})
    escape2 = 2.0 * G_NEWTON * sum(b.mass for b in heavy.bodies) / (2.0 ** (1.0 / 3.0) * 50e3)
    assert speed_of_motion(heavy) == pytest.approx(np.sqrt(300.0**2 + escape2), rel=1e-12)


def test_drift_of_momentum_has_no_direction() -> None:
    one, other = ({"momentum": np.array(values)} for values in ([1.0, 2.0, 3.0], [1.0, -1.0, 7.0]))
    assert momentum_drift(one, other) == momentum_drift(other, one) == 5.0


@pytest.mark.parametrize(
    ("changes", "momentum", "energy"),
    [
        ({}, True, True),
        ({"physics": PULLED}, False, True),
        ({"physics": {"fracture": None, "gravity": None, "walls": [{"point": [0.0, 0.0, -1e6]}]}}, False, True),
        ({"physics": {"fracture": None, "gravity": None, "energy": False}}, True, False),
    ],
)
def test_what_a_scene_conserves(changes, momentum, energy) -> None:
    given = scene(body(), **changes)
    assert (keeps_momentum(given), keeps_energy(given)) == (momentum, energy)
