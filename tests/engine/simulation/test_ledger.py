"""The ledger that the device sums, against sums of the same state with NumPy."""

from dataclasses import asdict

import numpy as np
import pytest

from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from tests.helpers import totals as host
from tests.helpers.device import finds
from tests.helpers.scenes import advance, body, rubble_collision, scene, started

pytestmark = pytest.mark.usefixtures("taichi")


def summed_on_the_host(simulation: Simulation) -> dict[str, object]:
    state, rho0 = simulation.particles.read(), simulation.rho0(simulation.particles.read("body"))
    materials = simulation.scene.materials
    bulk = np.array([material.eos.bulk_modulus() for material in materials])[state["body"]]
    shear = np.array([material.shear_modulus for material in materials])[state["body"]]
    return asdict(
        host.totals(
            state,
            simulation.scheme.inertia(simulation.scene.dx),
            host.elastic_energy(state, rho0, bulk, shear),
            simulation.totals().gravitational_energy,
            host.half_step_work(state, float(simulation.clock.dt[None])),
            simulation.scene.numerics.transfer_heat,
        )
    )


def bare() -> Scene:
    """No internal energy, no damage, no gravity."""
    physics = {"energy": False, "shear": False, "strength": False, "fracture": None, "gravity": None}
    return scene(body(velocity=(3.0, 2.0, 1.0), spin=(0.0, 0.0, 1e-4)), physics=physics)


@pytest.mark.parametrize("given", [rubble_collision, bare])
def test_sums_are_those_of_the_state(given):
    """Also where particles have been sorted, and where a scene leaves quantities out."""
    simulation = advance(started(given()), 80)
    expected, found = summed_on_the_host(simulation), asdict(simulation.totals())
    size = max(abs(expected[name]) for name in expected if name.endswith("energy"))
    for name, value in expected.items():
        allowed = 1e-13 * (size if "energy" in name or "work" in name or "heat" in name else 0.0)
        np.testing.assert_allclose(found[name], value, rtol=1e-12, atol=allowed, err_msg=name)


def test_sums_are_the_same_bits_wherever_particles_lie_on_the_device():
    simulation = advance(started(rubble_collision()), 80)
    again = Simulation(simulation.scene)
    again.restore(simulation.particles.read(*simulation.particles.allocated), simulation.clock_state())
    again.rebuild_blocks()
    for name, value in asdict(simulation.totals()).items():
        if name != "gravitational_energy":
            assert np.array_equal(asdict(again.totals())[name], value), name


def test_extremes_are_those_of_the_state():
    simulation = advance(started(rubble_collision()), 80)
    found, expected = simulation.ledger.extremes(), host.extremes(simulation.particles.read())
    assert asdict(found) == pytest.approx(asdict(expected), rel=1e-14) and found.is_finite


def test_a_number_that_is_not_finite_is_found_in_any_field():
    simulation = started(rubble_collision())
    for name in ("x", "v", "C", "tau", "b_minus_I", "damage_root", "E", "j"):
        assert finds(simulation, name, (np.nan, np.inf, -np.inf)) == [True, True, True], name


def test_matter_of_no_volume_is_beyond_every_density():
    """Not an error of its own: the guard names it."""
    simulation = started(rubble_collision())
    j = simulation.particles.read("j")["j"]
    j[3] = -1.0
    simulation.particles.write({"j": j})
    assert simulation.ledger.extremes().density == np.inf == simulation.ledger.extremes().compression


def test_half_a_step_of_work_takes_the_energy_of_a_fall_to_the_time_of_its_height():
    """Velocities belong to the middle of the step, so what is left is its second order, m (g dt)^2/8."""
    physics = {"energy": False, "shear": False, "strength": False, "fracture": None, "gravity": None}
    simulation = started(scene(body(), physics={**physics, "uniform_gravity": (1.0, -2.0, 3.0)}))
    before, after = simulation.totals(), advance(simulation, 20).totals()
    left = after.mass * 14.0 * simulation.clock.dt[None] ** 2 / 8.0
    assert before.total_energy - after.total_energy == pytest.approx(left, rel=1e-6)
    assert after.half_step_work > 100.0 * left
