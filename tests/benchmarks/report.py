"""The figures as one table."""

from typing import Any

from rich.console import Console
from rich.table import Table

PHASES = ("kick", "drift", "projection", "correction")
TITLES = (
    "particles",
    "threads",
    "reals",
    *PHASES,
    "step",
    "least",
    "CPU",
    "cores",
    "10^6 p-steps/s",
    "rel. cost",
    "rebuild",
    "gravity",
    "B/particle",
)

Results = dict[str, Any]


def print_report(results: Results) -> None:
    """Print the table of sizes, and below it the figures that belong to one size or none."""
    console = Console(width=150)
    host = results["host"]
    console.print(
        f"{results['date']}, {host['cores']} cores, {host['cpu']}, Taichi {host['taichi']}, "
        f"commit {results['commit']}; ms per step: medians, least, CPU time of all threads, cores it got"
    )
    table = Table(*TITLES)
    for row in [*results["sizes"], *results["single_precision"]]:
        table.add_row(*_cells(row, _reference(results["sizes"], row["threads"])))
    console.print(table)
    for line in _lines(results):
        console.print(line, highlight=False)


def _cells(row: Results, reference: Results) -> list[str]:
    step, gravity, rebuild = row["step"], row["gravity"], row["rebuild"]
    return [
        f"{row['particles']:,}",
        str(row["threads"]),
        row["precision"],
        *(f"{row['phases'][name]['median_ms']:.2f}" for name in PHASES),
        f"{step['median_ms']:.2f}",
        f"{step['least_ms']:.2f}",
        f"{step['cpu_ms']:.2f}",
        f"{step['cpu_ms'] / step['median_ms']:.1f}",
        f"{1e-3 * row['particles'] / step['least_ms']:.2f}",
        f"{_per_particle(row) / _per_particle(reference):.2f}",
        f"{rebuild['median_ms']:.1f}" if rebuild["count"] else "-",
        f"{gravity['median_ms']:.1f}",
        f"{row['bytes']['state_used']:.0f} of {row['bytes']['state']:.0f}",
    ]


def _per_particle(row: Results) -> float:
    return float(row["step"]["cpu_ms"] / row["particles"])


def _reference(sizes: list[Results], threads: int) -> Results:
    """The row of 2 x 20,000 particles."""
    return next(row for row in sizes if row["particles"] == 40_000 and row["threads"] == threads)


def _lines(results: Results) -> list[str]:
    baseline, dense, default = (results["baseline"][name] for name in ("baseline", "dense_grid_only", "default"))
    startup = results["startup"]
    return [
        *(
            f"cost ~ N^{row['least_ms']:.3f} (least), N^{row['cpu_ms']:.3f} (CPU) with {_threads(row)}"
            for row in results["slopes"]
        ),
        f"usual way / engine with APIC: {baseline['ratio']:.2f} (CPU {baseline['ratio_of_cpu']:.2f}); "
        f"dense atomic grid only: {dense['ratio']:.2f} (CPU {dense['ratio_of_cpu']:.2f}); "
        f"default transfer / APIC: {default['ratio']:.2f} (CPU {default['ratio_of_cpu']:.2f})",
        *(_limit(limit, used) for limit, used in zip(results["limits"], results["used"], strict=True)),
        f"start of a tiny run: {startup['cold']['wall']:.1f} s cold (CPU {startup['cold']['cpu']:.1f}), "
        f"{startup['warm']['wall']:.1f} s warm (CPU {startup['warm']['cpu']:.1f})",
        f"load of the machine: {results['load_before']:.1f} before, {results['load_after']:.1f} after",
    ]


def _threads(row: Results) -> str:
    return f"{row['threads']} thread{'s' if row['threads'] > 1 else ''}"


def _limit(limit: Results, used: Results) -> str:
    return (
        f"{_threads(limit)}: {1e-9 * limit['bytes_per_second']:.1f} GB/s copied, "
        f"{1e-9 * limit['operations_per_second']:.0f} Gflop/s; a step uses {100 * used['bandwidth']:.1f} % of the one "
        f"({used['bytes_per_particle_step']:.0f} B per particle) and {100 * used['arithmetic']:.1f} % of the other "
        f"({used['operations_per_particle_step']} operations)"
    )
