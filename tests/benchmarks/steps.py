"""Time of the engine's step and of its stages, at one size on a number of threads."""

from collections.abc import Callable, Sequence
from typing import Any

from engine.device import backend
from engine.device.backend import Real
from engine.device.launches import Launches
from engine.profile.parts import name_in_tuple
from engine.scene.scene import Gravity
from engine.simulation.simulation import Simulation
from tests.benchmarks.child import answer
from tests.benchmarks.contact import in_contact, make_ready
from tests.benchmarks.memory import allocated, bytes_per_step
from tests.benchmarks.scene import collision
from tests.benchmarks.stopwatch import Stopwatch, total

GRAVITY_CALLS = 3


def measure(particles: int, threads: int, contact: float, steps: int, arch: str = "cpu") -> dict[str, Any]:
    """Times of `steps` steps of two bodies of `particles` each, from `contact` [s] after they met."""
    backend.start(arch, threads)
    simulation = in_contact(collision(particles), contact)
    watches, rebuild = time_steps(simulation, steps)
    return {
        "particles": simulation.particles.count,
        "threads": threads,
        "precision": str(Real),
        "time": simulation.time,
        "dt": float(simulation.clock.dt[None]),
        "blocks": int(simulation.stencil.block_count[None]),
        "damaged": float((simulation.particles.read("damage_root")["damage_root"] >= 1.0).mean()),
        "steps": steps,
        "step": total(watches).summary(),
        "phases": phases(simulation, watches),
        "rebuild": {**rebuild.summary(), "count": len(rebuild.wall)},
        "gravity": gravity(particles).summary(),
        "bytes": {**allocated(simulation), "traffic": bytes_per_step(simulation)},
    }


def time_steps(simulation: Simulation, steps: int) -> tuple[list[Stopwatch], Stopwatch]:
    """Watches of the stages of `steps` steps, and of the rebuilding of blocks between them."""
    watches, rebuild = [Stopwatch() for _ in stages(simulation)], Stopwatch()
    before = simulation.step
    for _ in range(steps):
        if simulation.clock.moved_out[None]:
            with rebuild.lap():
                make_ready(simulation)
        for (_, run), watch in zip(stages(simulation), watches, strict=True):
            with watch.lap():
                run()
    assert simulation.step == before + steps, "the clock paused a step that was timed"
    return watches, rebuild


def stages(simulation: Simulation) -> list[tuple[str, Callable[[], None]]]:
    """Names and kernels of the stages of a step, in order."""
    transfer = simulation.transfer
    return [(name_in_tuple(part), Launches(*part.kernels)) for part in (transfer, *transfer.stages)]


def phases(simulation: Simulation, watches: Sequence[Stopwatch]) -> dict[str, dict[str, float]]:
    """Times of the stages by name: the sum of those that occur more than once in a step."""
    names = [name for name, _ in stages(simulation)]
    return {
        name: total([watch for other, watch in zip(names, watches, strict=True) if other == name]).summary()
        for name in names
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
