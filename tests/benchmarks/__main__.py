"""All measurements: `python -m tests.benchmarks` prints one table and writes one JSON file."""

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from engine.device.options import Precision
from tests.benchmarks import startup
from tests.benchmarks.child import ask
from tests.benchmarks.host import commit, host
from tests.benchmarks.operations import operations_per_step
from tests.benchmarks.report import print_report

SIZES = {1_000: (100.0, 200), 5_000: (100.0, 100), 20_000: (100.0, 40), 100_000: (40.0, 10)}
"""Particles per body: time [s] after contact of the state that is timed, and timed steps."""
REFERENCE = 20_000
ROUNDS = 16
THREADS = (1, 2)

Results = dict[str, Any]


def main(out: Annotated[Path, typer.Option(help="File for all figures, as JSON.")] = Path("runs/bench.json")) -> None:
    """Time the engine, compare it with the usual way and with the machine's limits."""
    results = {
        "date": datetime.now(UTC).date().isoformat(),
        "commit": commit(),
        "host": host(),
        "load_before": os.getloadavg()[0],
        **measure(),
        "load_after": os.getloadavg()[0],
    }
    print_report(results)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(f"written to {out}")


def measure() -> Results:
    """Every figure, each from a process of its own."""
    sizes = [_steps(particles, threads) for particles in SIZES for threads in THREADS]
    single = [_steps(particles, 1, "f32") for particles in SIZES]
    limits = [_tell("machine", threads=threads) for threads in THREADS]
    baseline = _tell("ratio", particles=REFERENCE, threads=max(THREADS), contact=SIZES[REFERENCE][0], rounds=ROUNDS)
    typer.echo("startup", err=True)
    return {
        "sizes": sizes,
        "single_precision": single,
        "slopes": [{"threads": threads, **_slopes(sizes, threads)} for threads in THREADS],
        "baseline": baseline,
        "limits": limits,
        "used": [{"threads": limit["threads"], **_used(sizes, limit)} for limit in limits],
        "startup": startup.measure(),
    }


def _steps(particles: int, threads: int, precision: Precision = "f64") -> Results:
    contact, steps = SIZES[particles]
    return _tell("steps", precision, particles=particles, threads=threads, contact=contact, steps=steps)


def _tell(module: str, precision: Precision = "f64", **arguments: float) -> Results:
    typer.echo(f"{module} {precision} {arguments}", err=True)
    return ask(module, precision, **arguments)


def _slopes(sizes: list[Results], threads: int) -> dict[str, float]:
    """Exponents of the cost of a step against the number of particles."""
    rows = [row for row in sizes if row["threads"] == threads]
    counts = np.log([row["particles"] for row in rows])
    costs = {name: np.log([row["step"][name] for row in rows]) for name in ("least_ms", "cpu_ms")}
    return {name: float(np.polyfit(counts, cost, 1)[0]) for name, cost in costs.items()}


def _used(sizes: list[Results], limit: Results) -> dict[str, float]:
    """Share of the machine's limits that the step of the reference size reaches."""
    [row] = [row for row in sizes if row["particles"] == 2 * REFERENCE and row["threads"] == limit["threads"]]
    rate = row["particles"] / (1e-3 * row["step"]["least_ms"])
    return {
        "bytes_per_particle_step": row["bytes"]["traffic"],
        "operations_per_particle_step": operations_per_step(),
        "bandwidth": rate * row["bytes"]["traffic"] / limit["bytes_per_second"],
        "arithmetic": rate * operations_per_step() / limit["operations_per_second"],
    }


if __name__ == "__main__":
    typer.run(main)
