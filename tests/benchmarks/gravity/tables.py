"""Results of all measurements of gravity as tables."""

from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

ERRORS = (0.1, 0.2, 0.5, 1.0, 2.0)
"""Errors [%] at which times are compared."""

Results = dict[str, Any]


def print_tables(results: Results) -> None:
    """Print all tables."""
    console = Console(width=120)
    for state, lines in results["curves"].items():
        console.print(curve_table(state, lines))
    console.print(run_table(results["run"]))
    console.print(scaling_table(results["scaling"]))
    console.print(interval_table(results["intervals"]))


def curve_table(state: str, lines: list[Results]) -> Table:
    """Times of all codes at equal errors."""
    table = Table("code", "expansion", *(f"{error} %" for error in ERRORS), title=f"{state}: CPU ms at this error")
    for line in lines:
        times = (time_at(line["rows"], 1e-2 * error) for error in ERRORS)
        expansion = "quadrupole" if line["quadrupole"] else "monopole"
        table.add_row(line["code"], expansion, *("-" if np.isnan(time) else f"{time:.0f}" for time in times))
    return table


def time_at(rows: list[Results], error: float) -> float:
    """CPU time [ms] at which the 99th percentile of the error is `error`, between measured points.

    Where a greater opening happens to err less, it counts with the error of the smaller one.
    """
    times, errors = (np.log([row[name] for row in rows]) for name in ("cpu_ms", "percentile_99"))
    rising = np.maximum.accumulate(errors)
    return float(np.exp(np.interp(np.log(error), rising, times, left=np.nan, right=np.nan)))


def run_table(run: Results) -> Table:
    """What gravity cost in a collision, and its error at the end."""
    title = f"Collision to {run['time']:.0f} s: {run['steps']:,} steps"
    table = Table("", "calls", "CPU s", "of the run", title=title)
    for name in ("accelerate", "energy"):
        spent = run[name]
        table.add_row(name, f"{spent['calls']:,}", f"{spent['cpu_s']:.1f}", f"{spent['cpu_s'] / run['cpu_s']:.1%}")
    table.add_row("all", "", f"{run['cpu_s']:.1f}", "")
    table.caption = f"errors at the end: median {run['median']:.3%}, 99th percentile {run['percentile_99']:.3%}"
    return table


def scaling_table(rows: list[Results]) -> Table:
    """Times of one evaluation, and the exponent of their growth."""
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


def interval_table(rows: list[Results]) -> Table:
    """What a collision loses."""
    table = Table("interval [s]", "net effect", "energy / kinetic", "angular momentum", "net force", "net torque")
    for row in rows:
        figures = (f"{row[name]:.1e}" for name in ("angular_momentum", "force", "torque"))
        effect = "taken out" if row["corrected"] else "left in"
        table.add_row(f"{row['interval']:.0f}", effect, f"{row['energy']:.5f}", *figures)
    return table
