"""Tests on a Vulkan device, which tests/engine/device/test_gpu.py runs in processes of their own."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from taichi import MatrixField, ScalarField

from engine.device import backend, elementary
from engine.device.backend import PRECISION
from engine.mpm.blocks import Blocks
from engine.scene.collision import Collision
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import Arrays
from tests.helpers.device import Array, evaluate
from tests.helpers.scenes import RUBBLE, body, rubble_collision, scene, started

DOUBLE = PRECISION == "f64"
STEPS = 30
"""Past contact and the first flow of rubble."""

ROUND_OFF = 1e-12 if DOUBLE else 1e-3
"""Of these steps, relative to the largest value."""

SETTINGS = {"numerics": {"precision": PRECISION}}


@pytest.fixture
def device() -> Iterator[None]:
    backend.start("vulkan")
    yield


def collision() -> Scene:
    """Two bodies about to touch: flaws, damage, contact, friction by Lode angle, self-gravity."""
    given = {"velocity": 200.0, "angle": 15.0, "particles": 100, "start_separation": 1.05, "end_time": 300.0}
    return Collision.model_validate({**given, "parameter_set": "rubble", **SETTINGS}).scene()


def other_parts() -> Scene:
    """What the collision leaves out: a wall, uniform gravity, viscosity, Murnaghan's equation, loosening, `apic`."""
    eos = {"form": "murnaghan", "K": 2.67e10, "n": 4.0}
    loosening = {"critical_density": 2000.0, "dilatancy": 0.177, "crushing_pressure": 1e7}
    rock = {"name": "basalt", "eos": eos, "friction_law": "matsuoka-nakai", **loosening}
    one = body(material=rock, particles=60, velocity=(30.0, 0.0, -100.0), position=(0.0, 0.0, 52e3))
    physics = {
        **RUBBLE,
        # the same for all particles: else the CPU takes shorter steps (engine/physics.md, section 10)
        "viscosity": {"shear": 1e4, "bulk": 1e4},
        "walls": [{"normal": (0.0, 0.0, 1.0), "friction": 0.5}],
        "uniform_gravity": (0.0, 0.0, -0.1),
    }
    return scene(one, physics=physics, numerics={"precision": PRECISION, "transfer": "apic"})


def state(simulation: Simulation) -> Arrays:
    return simulation.particles.read(*simulation.particles.allocated)


def after_steps(simulation: Simulation, steps: int = STEPS) -> Simulation:
    """Exactly these steps on."""
    end = simulation.step + steps
    while simulation.step < end:
        simulation.advance(simulation.scene.end_time, steps=end - simulation.step)
    return simulation


def test_it_runs_on_the_device(device: None) -> None:
    assert backend.on_gpu()


GENERATOR = np.random.default_rng(7)
FUNCTIONS = {
    "exp": (np.exp, GENERATOR.uniform(-700.0, 700.0, 4096)),
    "expm1": (np.expm1, GENERATOR.uniform(-5.0, 5.0, 4096)),
    "log": (np.log, 10.0 ** GENERATOR.uniform(-307.0, 308.0, 4096)),
    "log1p": (np.log1p, GENERATOR.uniform(-0.9, 9.0, 4096)),
    "cbrt": (np.cbrt, 10.0 ** GENERATOR.uniform(-100.0, 100.0, 4096)),
    "sin": (np.sin, GENERATOR.uniform(-1e5, 1e5, 100_000)),
    "cos": (np.cos, GENERATOR.uniform(-1e5, 1e5, 100_000)),
    "asin": (np.arcsin, np.linspace(-1.0, 1.0, 100_001)),
    "acos": (np.arccos, np.linspace(-1.0, 1.0, 100_001)),
}


def place(values: Array) -> Array:
    """Unit in the last place; a process in which Taichi has started reads subnormal numbers as zero."""
    return np.maximum(np.spacing(np.abs(values)), np.finfo(float).tiny)


@pytest.mark.skipif(not DOUBLE, reason="in single precision they are the device's own")
@pytest.mark.parametrize("name", FUNCTIONS)
def test_elementary_functions_err_in_the_last_places(device: None, name: str) -> None:
    exact, x = FUNCTIONS[name]
    (found,) = evaluate(getattr(elementary, name), x)
    assert (np.abs(found - exact(x)) / place(exact(x))).max() <= (4.0 if name in ("expm1", "log1p") else 3.0)


@pytest.mark.skipif(not DOUBLE, reason="in single precision they are the device's own")
def test_what_is_no_number_stays_none(device: None) -> None:
    """The guard sees it then."""
    (logs,) = evaluate(elementary.log, np.array([-1.0, np.nan, 0.0]))
    assert np.isnan(logs[:2]).all() and logs[2] == -np.inf
    (powers,) = evaluate(elementary.power, np.array([-0.5, np.nan]), np.array([3.5, 1.0]))
    assert np.isnan(powers).all()
    (exponentials,) = evaluate(elementary.exp, np.array([-1e30, 1e30, np.nan]))
    assert exponentials[0] == 0.0 and exponentials[1] == np.inf and np.isnan(exponentials[2])


@pytest.mark.skipif(not DOUBLE, reason="in single precision they are the device's own")
def test_powers_err_by_as_many_places_as_the_logarithm_is_long(device: None) -> None:
    x, y = np.geomspace(1e-3, 1e3, 4096), np.linspace(-3.0, 3.0, 4096)
    (found,) = evaluate(elementary.power, x, y)
    assert (np.abs(found / x**y - 1.0) <= (2.0 + np.abs(y * np.log(x))) * np.finfo(float).eps).all()


@pytest.mark.parametrize("given", [collision, other_parts])
def test_a_scene_is_that_of_the_cpu(given: Callable[[], Scene]) -> None:
    """Laws, transfer, contact, tree, sorting into blocks, and the ledger."""
    found = []
    for arch in ("cpu", "vulkan"):
        backend.start(arch, threads=1)
        simulation = after_steps(started(given()))
        found.append((simulation.step, simulation.time, state(simulation), simulation.totals()))
    (step, time, cpu, ledger), (other_step, other_time, gpu, other_ledger) = found
    assert step == other_step and time == pytest.approx(other_time, rel=ROUND_OFF)
    assert cpu["plastic_heat"].max() > 0.0, "rubble flows"
    for name, values in cpu.items():
        assert np.abs(gpu[name] - values).max() <= ROUND_OFF * np.abs(values).max(), name
    assert other_ledger.total_energy == pytest.approx(ledger.total_energy, rel=ROUND_OFF)


@pytest.mark.skipif(not DOUBLE, reason="the same calls in single precision")
def test_nothing_but_scalars_crosses_between_outputs(device: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps, sorting, gravity and the row of a history move no field of particles between device and host."""
    simulation, crossed, sorts = started(collision()), [], []
    first = simulation.events.gravity_due
    for kind in (ScalarField, MatrixField):
        for name in ("to_numpy", "from_numpy"):
            monkeypatch.setattr(kind, name, recorded(getattr(kind, name), crossed))
    monkeypatch.setattr(Blocks, "write", recorded(Blocks.write, sorts))
    after_steps(simulation, 3 * STEPS)
    simulation.totals()
    simulation.ledger.extremes()
    assert sorts and simulation.events.gravity_due > first + simulation.scene.physics.gravity.interval
    assert [field.shape for field in crossed if field.shape != ()] == []
    simulation.particles.read("mass")
    assert crossed[-1].shape != (), "what crosses is seen"


def recorded(method: Callable[..., Any], calls: list[Any]) -> Callable[..., Any]:
    """A method that adds its object to a list."""

    def call(self: Any, *given: Any, **named: Any) -> Any:
        calls.append(self)
        return method(self, *given, **named)

    return call


def test_the_same_run_has_the_same_bits_and_so_has_a_restart(device: None) -> None:
    """However many steps are launched at once."""
    first, second = after_steps(started(collision())), started(collision())
    while second.step < first.step:
        second.advance(second.scene.end_time, steps=min(7, first.step - second.step))
        if second.step < STEPS // 2:
            kept, clock = state(second), second.clock_state()
    third = Simulation(collision())
    third.restore(kept, clock)
    after_steps(third, first.step - third.step)
    for other in (second, third):
        assert all(np.array_equal(values, state(other)[name]) for name, values in state(first).items())


def test_momentum_and_angular_momentum_are_kept_to_round_off(device: None) -> None:
    simulation = started(rubble_collision(**SETTINGS))
    before, given = simulation.totals(), simulation.particles.read("x", "v", "mass")
    momentum = given["mass"] * np.linalg.norm(given["v"], axis=1)
    arm = np.linalg.norm(given["x"], axis=1)
    after = after_steps(simulation).totals()
    allowed = 1e-13 if DOUBLE else 1e-5
    assert np.abs(after.momentum - before.momentum).max() < allowed * momentum.sum()
    assert np.abs(after.angular_momentum - before.angular_momentum).max() < allowed * (momentum * arm).sum()
