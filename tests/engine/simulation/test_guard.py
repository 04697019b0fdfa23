"""The guard: every bound holds what it should and names what breaks it."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from campaigns.job_state import TrackedJob, status_of
from campaigns.progress import line
from engine.device import backend
from engine.errors import Fault, GuardFault, stop
from engine.job.checkpoint import save_checkpoint
from engine.job.directory import JobDirectory, Status
from engine.job.session import Options, Session
from engine.scene.collision import Collision
from engine.scene.scene import Physics, Scene, Wall
from engine.simulation.bounds import energy_growth, largest_energy_change, speed_scale
from engine.simulation.conservation import Row, as_row
from engine.simulation.guard import LARGEST_DRIFT, SPEED_FACTOR, STEPS_FACTOR, Guard
from engine.simulation.simulation import Simulation
from engine.state.particles import Arrays, Particles
from tests.helpers.jobs import write_job
from tests.helpers.scenes import body, scene
from tests.helpers.totals import extremes, totals

COUNT = 20


def collision(**changes: Any) -> Scene:
    """Two bodies of half the particles each."""
    return Collision.model_validate({"velocity": 200.0, "angle": 0.0, "particles": COUNT // 2, **changes}).scene()


def state_of(given: Scene) -> Arrays:
    """A state as calm as can be."""
    generator, count = np.random.default_rng(1), given.particles
    return {
        "x": generator.normal(size=(count, 3)),
        "v": np.array([[100.0, 0.0, 0.0], [-100.0, 0.0, 0.0]] * (count // 2)),
        "C": np.zeros((count, 3, 3)),
        "j": np.zeros(count),
        "E": np.zeros(count),
        "mass": np.full(count, 3.0),
        **{
            name: np.zeros(count)
            for name in (
                "plastic_dilation",
                "transfer_heat",
                "plastic_heat",
                "viscous_heat",
                "affine_loss",
                "damage_root",
            )
        },
    }


def row_of(state: Arrays, gravity: float = 0.0) -> Row:
    return as_row(totals(state, 0.25, np.zeros(len(state["mass"])), gravity, 0.0), time=5.0)


def guard_of(given: Scene) -> tuple[Guard, Arrays]:
    state = state_of(given)
    return Guard(given, row_of(state), dt=2.0), state


@dataclass(frozen=True)
class Held:
    """Particles in a given state."""

    state: Arrays

    def read(self) -> Arrays:
        return self.state


def check(guard: Guard, row: Row, state: Arrays) -> None:
    guard.check(row, extremes(state), Held(state))


def stopped(guard: Guard, state: Arrays, row: Row | None = None) -> Fault:
    """What the guard says of a state."""
    with pytest.raises(GuardFault) as caught:
        check(guard, row_of(state) if row is None else row, state)
    return caught.value.fault


def changed(state: Arrays, name: str, value: Any, particle: int = 7) -> Arrays:
    values = state[name].copy()
    values[particle] = value
    return {**state, name: values}


def test_a_calm_state_passes():
    guard, state = guard_of(collision())
    check(guard, row_of(state), state)


@pytest.mark.parametrize("name", ["x", "v", "C", "j", "E"])
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_not_finite_is_named(name, bad):
    guard, state = guard_of(collision())
    fault = stopped(guard, changed(state, name, bad))
    assert (fault.quantity, fault.particle, fault.value, fault.allowed, fault.time) == (name, 7, None, "finite", 5.0)
    assert f"{name} of particle 7 is not finite at t = 5 s" in str(fault) and "history_interval" in fault.advice


@pytest.mark.parametrize("name", ["momentum", "total_energy", "gravitational_energy"])
def test_a_total_that_is_not_finite_is_named_before_any_bound_of_it(name):
    guard, state = guard_of(collision())
    fault = stopped(guard, state, {**row_of(state), name: np.array(np.inf)})
    assert (fault.quantity, fault.particle, fault.value, fault.allowed) == (name, None, None, "finite")
    assert "history_interval" in fault.advice


def test_smaller_steps_are_advised_only_where_they_can_help():
    guard, state = guard_of(collision())
    row = row_of(state)
    won = {**row, "total_energy": 2.0 * row["total_energy"]}
    pushed = {**row, "momentum": row["momentum"] + 1e30}
    assert "cfl" in stopped(guard, changed(state, "v", [1e30, 0.0, 0.0]), row).advice
    assert "cfl" in stopped(guard, state, won).advice
    assert "cfl" not in stopped(guard, state, pushed).advice and "f64" in stopped(guard, state, pushed).advice
    assert "cfl" not in stopped(guard, state, {**row, "mass": 2.0 * row["mass"]}).advice


def test_a_speed_beyond_ten_times_the_scenes_is_named():
    guard, state = guard_of(collision(gravity=None))
    # 200 m/s between the bodies, and the kinetic energy per mass of a state at 100 m/s
    assert guard.speed == pytest.approx(SPEED_FACTOR * np.hypot(200.0, 100.0))
    fast = changed(state, "v", [0.0, 1.001 * guard.speed, 0.0])
    fault = stopped(guard, fast, row_of(state))
    assert (fault.quantity, fault.particle, fault.value) == ("speed [m/s]", 7, pytest.approx(1.001 * guard.speed))
    check(guard, row_of(state), changed(state, "v", [0.0, 0.999 * guard.speed, 0.0]))


def test_gravity_and_spin_widen_the_bound_of_speeds():
    heavy = collision()
    plain = heavy.model_copy(update={"physics": Physics(gravity=None)})
    start = row_of(state_of(plain))
    mass = sum(part.mass for part in heavy.bodies)
    well = 3.0 * 6.6743e-11 * mass / heavy.spacing
    assert speed_scale(heavy, start) ** 2 == pytest.approx(speed_scale(plain, start) ** 2 + well)
    turning = scene(body(velocity=(0.0, 3.0, 4.0), spin=(0.0, 0.0, 1e-4)))
    assert speed_scale(turning, {**start, "kinetic_energy": np.zeros(())}) == pytest.approx(2.0 * (5.0 + 5.0))


def test_a_compression_beyond_the_energy_of_the_bound_is_named():
    guard, state = guard_of(collision())
    j = 1.0 / (1.001 * guard.compression) - 1.0
    fault = stopped(guard, changed(state, "j", j))
    assert (fault.quantity, fault.particle) == ("rho/rho0", 7)
    check(guard, row_of(state), changed(state, "j", 1.0 / (0.999 * guard.compression) - 1.0))


def test_mass_must_stay_to_the_round_off_of_its_sum():
    guard, state = guard_of(collision())
    check(guard, row_of(changed(state, "mass", 3.0 * (1.0 + 1e-12))), state)
    fault = stopped(guard, changed(state, "mass", 3.0 * (1.0 + 1e-9)))
    assert fault.quantity == "total mass [kg]" and fault.particle is None


def test_momentum_may_change_by_round_off_only_unless_something_pushes():
    given = collision()
    guard, state = guard_of(given)
    row = row_of(state)
    allowed = LARGEST_DRIFT * guard.momentum
    pushed = {**row, "momentum": row["momentum"] + [0.0, 1.01 * allowed, 0.0]}
    assert stopped(guard, state, pushed).quantity == "change of total momentum [kg m/s]"
    check(guard, {**row, "momentum": row["momentum"] + [0.0, 0.99 * allowed, 0.0]}, state)
    for outside in ({"walls": (Wall(),)}, {"uniform_gravity": (0.0, 0.0, -1.0)}):
        free = given.model_copy(update={"physics": Physics(gravity=None, **outside)})
        check(guard_of(free)[0], pushed, state)


@pytest.mark.parametrize("transfer", ["filtered", "apic"])
def test_energy_is_kept_or_lost_where_the_transfer_may_but_not_won(transfer):
    given = collision(numerics={"transfer": transfer})
    guard, state = guard_of(given)
    row = row_of(state)
    kinetic, most = float(row["kinetic_energy"]), largest_energy_change(given)
    least = -1.0 if transfer == "apic" else -most
    for change, passes in ((0.99 * most, True), (1.01 * most, False), (0.99 * least, True), (1.01 * least, False)):
        now = {**row, "total_energy": row["total_energy"] + change * kinetic}
        assert energy_growth(given, now, row) == pytest.approx(change, rel=1e-6)
        if passes:
            check(guard, now, state)
        else:
            assert stopped(guard, state, now).quantity.startswith("growth of total energy")


def test_energy_that_gravity_gives_counts_as_there_from_the_start():
    given = collision()
    state = state_of(given)
    start, fallen = row_of(state, gravity=-1e5), row_of(state, gravity=-9e5)
    kinetic = float(start["kinetic_energy"])
    assert energy_growth(given, fallen, start) == pytest.approx(-8e5 / (kinetic + 9e5))


@pytest.mark.parametrize(
    "change",
    [
        {"physics": Physics(gravity=None, uniform_gravity=(1.0, 0.0, 0.0)), "period": (4.0, None, None)},
        {"physics": Physics(strength=False, fracture=None, energy=False)},
    ],
)
def test_where_energy_is_not_known_it_is_not_compared(change):
    guard, state = guard_of(collision().model_copy(update=change))
    row = row_of(state)
    check(guard, {**row, "total_energy": np.array(1e30)}, state)


@pytest.mark.parametrize("dt", [0.0, np.nan, 1.99 / STEPS_FACTOR])
def test_a_collapsed_time_step_names_the_wildest_particle(taichi, dt):
    guard, state = guard_of(collision())
    particles = Particles(COUNT)
    particles.write(changed(state, "C", 1e3 * np.eye(3)))
    guard.check_time_step(2.01 / STEPS_FACTOR, 5.0, particles)
    with pytest.raises(GuardFault) as caught:
        guard.check_time_step(dt, 5.0, particles)
    assert (caught.value.fault.quantity, caught.value.fault.particle) == ("time step [s]", 7)
    assert "cfl" not in caught.value.fault.advice


def test_a_status_keeps_its_fault_in_parts_and_campaigns_show_it(tmp_path: Path) -> None:
    fault = stop("speed [m/s]", np.inf, "at most 3", 1.5, 4, advice="slow down").fault
    JobDirectory(tmp_path).write_status(Status(state="failed", reason=str(fault), fault=fault))
    assert JobDirectory(tmp_path).status().fault == fault
    written = json.loads((tmp_path / "status.json").read_text())["fault"]
    assert written == {**asdict(fault), "value": None}
    shown = TrackedJob(tmp_path, status_of(tmp_path))
    assert shown.status.fault == fault and str(fault) in line(shown)


def test_a_run_that_goes_bad_keeps_its_checkpoint(tmp_path: Path, taichi: None) -> None:
    """A particle at a thousandth of the speed of light is stopped before anything is written over."""
    job = JobDirectory(write_job(tmp_path / "job"))
    given = Scene.model_validate_json((job.path / "scene.json").read_text())
    simulation = Simulation(given)
    simulation.start()
    velocity = simulation.particles.read("v")["v"]
    velocity[7] = [3e5, 0.0, 0.0]
    simulation.particles.write({"v": velocity})
    save_checkpoint(
        job, simulation, {"history_due": given.start_time, "snapshot_due": np.inf, "wall_time": 0.0, "cpu_time": 0.0}
    )
    before = job.checkpoint.read_bytes()
    backend.start(threads=1)
    status = Session(given, job, Options(checkpoint_interval=0.0)).to_end()
    assert status.state == "failed" and job.status().fault == status.fault
    assert status.fault is not None and status.reason == str(status.fault)
    assert job.checkpoint.read_bytes() == before and not job.previous_checkpoint.exists()
    assert not job.final.exists()
