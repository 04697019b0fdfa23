"""All measurements of gravity: `python -m tests.benchmarks.gravity` prints tables, writes JSON and a figure."""

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from tests.benchmarks.child import ask
from tests.benchmarks.gravity.figure import draw
from tests.benchmarks.gravity.states import LATE, PER_BODY, SPHERE, late, save, sphere
from tests.benchmarks.host import commit, host

LINES = (
    ("this project", True),
    ("this project", False),
    ("pytreegrav", True),
    ("pytreegrav", False),
    ("rebound", False),
)
"""Code, and whether nodes have quadrupoles."""
COUNTS = (10_000, 30_000, 100_000, 300_000, 1_000_000)
INTERVALS = (5.0, 10.0, 20.0, 40.0, 80.0)
ERRORS = (0.1, 0.2, 0.5, 1.0, 2.0)
"""Errors [%] at which times are compared."""

Results = dict[str, Any]


def main(out: Annotated[Path, typer.Option(help="Directory of all results.")] = Path("runs/bench-gravity")) -> None:
    """Compare gravity with other codes, and measure its scaling and what it conserves."""
    out = out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    results = {
        "date": datetime.now(UTC).date().isoformat(),
        "commit": commit(),
        "host": host(),
        "curves": curves(out),
        "scaling": [_tell("scaling", count=count, threads=1) for count in COUNTS],
        "intervals": [
            *(_tell("interval", interval=interval, corrected=True) for interval in INTERVALS),
            _tell("interval", interval=20.0, corrected=False),
        ],
    }
    (out / "gravity.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    draw(results["curves"], out / "gravity.png")
    print_report(results)
    print(f"written to {out}")


def curves(out: Path) -> dict[str, list[Results]]:
    """Error against time of every code on both states."""
    states = {LATE: late(out / "late"), SPHERE: sphere(2 * PER_BODY)}
    result = {}
    for name, state in states.items():
        path = out / f"{name.replace(' ', '-')}.npz"
        save(state, path)
        result[name] = [
            _tell("curve", code=code, state=str(path), threads=1, quadrupole=quadrupole) for code, quadrupole in LINES
        ]
    return result


def _tell(module: str, **arguments: Any) -> Results:
    typer.echo(f"{module} {arguments}", err=True)
    return ask(f"gravity.{module}", **arguments)


def print_report(results: Results) -> None:
    """Print all tables."""
    console = Console(width=120)
    for state, lines in results["curves"].items():
        console.print(_curve_table(state, lines))
    console.print(_scaling_table(results["scaling"]))
    console.print(_interval_table(results["intervals"]))


def _curve_table(state: str, lines: list[Results]) -> Table:
    table = Table("code", "expansion", *(f"{error} %" for error in ERRORS), title=f"{state}: CPU ms at this error")
    for line in lines:
        times = (time_at(line["rows"], 1e-2 * error) for error in ERRORS)
        expansion = "quadrupole" if line["quadrupole"] else "monopole"
        table.add_row(line["code"], expansion, *("-" if np.isnan(time) else f"{time:.0f}" for time in times))
    return table


def time_at(rows: list[Results], error: float) -> float:
    """CPU time [ms] at which the 99th percentile of the error is `error`, between measured points."""
    times, errors = (np.log([row[name] for row in rows]) for name in ("cpu_ms", "percentile_99"))
    return float(np.exp(np.interp(np.log(error), errors, times, left=np.nan, right=np.nan)))


def _scaling_table(rows: list[Results]) -> Table:
    counts, times = (np.array([row[name] for row in rows]) for name in ("count", "accelerate"))
    slope = np.polyfit(np.log(counts), np.log(times), 1)[0]
    ideal = np.polyfit(np.log(counts), np.log(counts * np.log(counts)), 1)[0]
    title = f"CPU ms of one evaluation ~ N^{slope:.2f}; N log N would be N^{ideal:.2f}"
    table = Table("particles", "arrange", "tree and walk", "all", "all / N log2 N [ns]", title=title)
    for row in rows:
        share = 1e6 * row["accelerate"] / (row["count"] * np.log2(row["count"]))
        times_ = (f"{row[name]:.1f}" for name in ("arrange", "solve", "accelerate"))
        table.add_row(f"{row['count']:,}", *times_, f"{share:.0f}")
    return table


def _interval_table(rows: list[Results]) -> Table:
    table = Table("interval [s]", "energy / kinetic", "angular momentum", "net force", "net torque", title="Drift")
    for row in rows:
        left_in = "" if row["corrected"] else ", torque left in"
        figures = (f"{row[name]:.1e}" for name in ("angular_momentum", "force", "torque"))
        table.add_row(f"{row['interval']:.0f}{left_in}", f"{row['energy']:.5f}", *figures)
    return table


if __name__ == "__main__":
    typer.run(main)
