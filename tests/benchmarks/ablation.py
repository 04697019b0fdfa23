"""What each part of the physics costs: `python -m tests.benchmarks.ablation` leaves each out, or adds it, in turn.

All variants of a collision start from the state of the whole scene, and take turns of a few steps within one process,
so that other load disturbs all alike; a cost is the median over the turns of the difference to the whole scene.
"""

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from engine.device import backend
from engine.profile.parts import allocated_bytes, parts_of
from engine.scene.scene import Gravity, Scene, ViscosityCoefficients, Wall
from engine.simulation.simulation import Simulation
from tests.benchmarks.contact import continued, in_contact, take_step
from tests.benchmarks.host import commit, host
from tests.benchmarks.scene import collision
from tests.benchmarks.stopwatch import Stopwatch

VARIANTS: dict[str, dict[str, Any]] = {
    "without energy": {"energy": False},
    "without fracture": {"fracture": None},
    "without strength, fracture": {"strength": False, "fracture": None},
    "without shear, strength, fracture": {"shear": False, "strength": False, "fracture": None},
    "without gravity": {"gravity": None},
    "without contact": {"contact": None},
    "with viscosity": {"viscosity": ViscosityCoefficients(shear=1e5, shock_linear=1.0, shock_quadratic=2.0)},
    "with a wall": {"walls": (Wall(point=(0.0, 0.0, -1e7), friction=0.5),)},
}
STATES = {"intact": (1.5, -200.0), "rubble": (1.05, 100.0)}
"""Separation at the start [R1 + R2] and time [s] after contact: while nothing is broken, and when nearly all is."""
BATCH = 5
"""Steps of one turn."""

Results = dict[str, Any]


def main(
    particles: Annotated[int, typer.Option(help="Particles of each of the two bodies.")] = 20_000,
    rounds: Annotated[int, typer.Option(help="Turns of every variant.")] = 12,
    out: Annotated[Path, typer.Option(help="File for all figures, as JSON.")] = Path("runs/ablation.json"),
) -> None:
    """Measure what each part costs in CPU time and memory."""
    backend.start(threads=1)
    results = {
        "date": datetime.now(UTC).date().isoformat(),
        "commit": commit(),
        "host": host(),
        "load": os.getloadavg()[0],
        "particles": 2 * particles,
        "states": {
            name: measure(collision(particles, Gravity(), start), time, rounds)
            for name, (start, time) in STATES.items()
        },
    }
    print_table(results)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(f"written to {out}")


def measure(scene: Scene, time: float, rounds: int) -> Results:
    """CPU time of a step [ms] and memory [bytes per particle] of the whole scene, and changes in the variants."""
    whole = in_contact(scene, time)
    simulations = {"whole": whole, **{name: variant(whole, changes) for name, changes in VARIANTS.items()}}
    watches = take_turns(simulations, rounds)
    gravity = evaluation(whole)
    per_step = {name: 1e3 * np.array(watch.cpu) / BATCH for name, watch in watches.items()}
    per_step = {name: cpu + (0.0 if name == "without gravity" else gravity) for name, cpu in per_step.items()}
    return {
        "damaged": float((whole.particles.read("damage_root")["damage_root"] >= 1.0).mean()),
        "gravity_cpu_ms": gravity,
        "whole": {"cpu_ms": float(np.median(per_step["whole"])), "bytes": memory(whole)},
        **{name: change(per_step, name, simulations[name], whole) for name in VARIANTS},
    }


def take_turns(simulations: dict[str, Simulation], rounds: int) -> dict[str, Stopwatch]:
    """Times of batches of steps; the first step of each, which compiles it, is not timed."""
    watches = {name: Stopwatch() for name in simulations}
    for simulation in simulations.values():
        take_step(simulation)
    for _ in range(rounds):
        for name, simulation in simulations.items():
            with watches[name].lap():
                for _ in range(BATCH):
                    take_step(simulation)
    return watches


def variant(whole: Simulation, changes: Results) -> Simulation:
    """The scene with other physics, in the state of the whole one."""
    physics = whole.scene.physics.model_copy(update=changes)
    return continued(whole, whole.scene.model_copy(update={"physics": physics}))


def evaluation(whole: Simulation) -> float:
    """CPU time [ms] that evaluations of gravity take of each step."""
    watch, gravity = Stopwatch(), whole.scene.physics.gravity
    assert gravity
    for _ in range(3):
        with watch.lap():
            whole.gravity.accelerate(ahead=0.0)
    return watch.summary()["cpu_ms"] * float(whole.clock.dt[None]) / gravity.interval


def change(per_step: Results, name: str, simulation: Simulation, whole: Simulation) -> Results:
    """What a variant adds to the whole scene; negative when it saves."""
    difference = per_step[name] - per_step["whole"]
    lower, median, upper = np.percentile(difference, [25, 50, 75])
    share = float(median / np.median(per_step["whole"]))
    return {
        "cpu_ms": float(median),
        "quartiles_ms": [float(lower), float(upper)],
        "share": share,
        "bytes": memory(simulation) - memory(whole),
    }


def memory(simulation: Simulation) -> float:
    """Bytes per particle of all fields but the grid's, which depend on where particles are."""
    fields = [field for part in parts_of(simulation) if part.name != "stencil" for field in part.fields.values()]
    return sum(map(allocated_bytes, fields)) / simulation.particles.count


def print_table(results: Results) -> None:
    """One row a variant, with its changes in every state."""
    states = results["states"]
    console = Console(width=130)
    console.print(
        f"{results['date']}, {results['particles']:,} particles, 1 thread, {results['host']['cpu']}, commit "
        f"{results['commit']}, load {results['load']:.1f}; CPU time of a step, quartiles of its change over the turns"
    )
    table = Table("", *(f"{name} ({100 * found['damaged']:.0f} % damaged)" for name, found in states.items()), "memory")
    whole = [f"{found['whole']['cpu_ms']:.2f} ms" for found in states.values()]
    table.add_row("whole scene", *whole, f"{states['rubble']['whole']['bytes']:.0f} B/particle")
    for name in VARIANTS:
        table.add_row(
            name, *(_cell(found[name]) for found in states.values()), f"{states['rubble'][name]['bytes']:+.0f}"
        )
    console.print(table)


def _cell(found: Results) -> str:
    lower, upper = found["quartiles_ms"]
    return f"{found['cpu_ms']:+.2f} ms ({lower:+.2f} to {upper:+.2f}), {100 * found['share']:+.0f} %"


if __name__ == "__main__":
    typer.run(main)
