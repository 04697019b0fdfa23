"""Time of the engine's step and of its stages, at one size on a number of threads."""

import time
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from engine.device import backend
from engine.device.backend import Real
from engine.device.launches import Launches
from engine.mpm.transfer import Transfer
from engine.profile.parts import name_in_tuple
from engine.scene.scene import Gravity
from engine.simulation.simulation import Simulation
from tests.benchmarks.child import answer
from tests.benchmarks.contact import in_contact, make_ready
from tests.benchmarks.memory import allocated, bytes_per_step
from tests.benchmarks.scene import collision
from tests.benchmarks.stopwatch import Stopwatch, total

GRAVITY_CALLS, LAUNCHES = 3, 50


def measure(particles: int, threads: int, contact: float, steps: int, arch: str = "cpu") -> dict[str, Any]:
    """Times of `steps` steps of two bodies of `particles` each, from `contact` [s] after they met."""
    backend.start(arch, threads)
    simulation = in_contact(collision(particles), contact)
    whole, by_stage, rebuild = time_steps(simulation, steps)
    return {
        "particles": simulation.particles.count,
        "threads": threads,
        "precision": str(Real),
        "time": simulation.time,
        "dt": float(simulation.clock.dt[None]),
        "blocks": int(simulation.stencil.block_count[None]),
        "damaged": float((simulation.particles.read("damage_root")["damage_root"] >= 1.0).mean()),
        "steps": steps,
        "step": whole.summary(),
        "launches": sum(len(part.kernels) for part in (simulation.transfer, *simulation.transfer.stages)),
        "launch_ms": launching(simulation),
        "phases": {name: watch.summary() for name, watch in by_stage.items()},
        "rebuild": {**rebuild.summary(), "count": len(rebuild.wall)},
        "gravity": gravity(particles).summary(),
        "bytes": {**allocated(simulation), "traffic": bytes_per_step(simulation)},
    }


def time_steps(simulation: Simulation, steps: int) -> tuple[Stopwatch, dict[str, Stopwatch], Stopwatch]:
    """Watches of `steps` steps, of the stages of as many others by name, and of sorting into blocks between them."""
    whole, by_stage, rebuild = Stopwatch(), [Stopwatch() for _ in stages(simulation.transfer)], Stopwatch()
    before = simulation.step
    for turn in range(2 * steps):
        if simulation.clock.moved_out[None]:
            with rebuild.lap():
                make_ready(simulation)
        if turn % 2 == 0:
            with whole.lap():
                simulation.transfer.step()
        else:
            for (_, run), watch in zip(stages(simulation.transfer), by_stage, strict=True):
                with watch.lap():
                    run()
    assert simulation.step == before + 2 * steps, "the clock paused a step that was timed"
    return whole, phases(simulation, by_stage), rebuild


def launching(simulation: Simulation) -> float:
    """Time [ms] in which the host launches a step that the clock pauses, so that the device has nothing to do."""
    simulation.clock.pause_time[None] = simulation.time
    simulation.transfer.step()
    backend.wait()
    begun = time.perf_counter()
    for _ in range(LAUNCHES):
        simulation.transfer.step()
    launched = time.perf_counter() - begun
    backend.wait()
    return 1e3 * launched / LAUNCHES


@cache
def stages(transfer: Transfer) -> list[tuple[str, Callable[[], None]]]:
    """Names and kernels of the stages of a step, in order."""
    parts = [("begin", transfer), *((name_in_tuple(stage), stage) for stage in transfer.stages)]
    return [(name, Launches(*part.kernels)) for name, part in parts]


def phases(simulation: Simulation, watches: Sequence[Stopwatch]) -> dict[str, Stopwatch]:
    """Watches of the stages by name: the sum of those that occur more than once in a step."""
    names = [name for name, _ in stages(simulation.transfer)]
    return {
        name: total([watch for other, watch in zip(names, watches, strict=True) if other == name]) for name in names
    }


def gravity(particles: int) -> Stopwatch:
    """Time of evaluations of gravity at the start of the same scene."""
    simulation, watch = Simulation(collision(particles, Gravity())), Stopwatch()
    simulation.start()
    assert simulation.gravity
    simulation.gravity.accelerate(ahead=0.0)
    for _ in range(GRAVITY_CALLS):
        with watch.lap():
            simulation.gravity.accelerate(ahead=0.0)
    return watch


if __name__ == "__main__":
    answer(measure)
