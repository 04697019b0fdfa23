"""Running verification problems one after the other; their results on the screen and in a CSV file."""

import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from math import inf
from pathlib import Path

import pandas as pd
from rich.table import Table

from engine.device import backend
from engine.errors import RunFault
from engine.verification.check import Check, Problem
from engine.verification.harness import Harness


@dataclass(frozen=True)
class Result:
    """How one problem ended.

    Attributes:
        name: of the problem.
        checks: its comparisons; none when it broke off.
        wall_time: computing time [s].
        fault: why it broke off, or empty.
    """

    name: str
    checks: list[Check]
    wall_time: float
    fault: str = ""

    @property
    def passed(self) -> bool:
        """Whether it ran to its end and every error is allowed."""
        return not self.fault and all(check.passed for check in self.checks)


def run_all(problems: Iterable[Problem], arch: str, threads: int) -> Iterator[Result]:
    """Run the problems, each in a fresh Taichi program; yield each result as it is known.

    Args:
        problems: what to run.
        arch: Taichi's name of the device.
        threads: CPU threads.
    """
    for problem in problems:
        backend.start(arch, threads)
        begun = time.monotonic()
        try:
            checks, fault = problem.checks(Harness()), ""
        except RunFault as error:
            checks, fault = [], str(error)
        yield Result(problem.name, checks, time.monotonic() - begun, fault)


def table(results: Iterable[Result]) -> Table:
    """Return the table to print: scene, quantity, measured, expected, error, allowed and computing time."""
    result_table = Table()
    for column in ("scene", "quantity", "unit"):
        result_table.add_column(column, no_wrap=True)
    for column in ("measured", "expected", "error", "allowed", "time [s]"):
        result_table.add_column(column, justify="right", no_wrap=True)
    result_table.add_column("")
    for result in results:
        for row in _rows(result):
            result_table.add_row(*row)
        result_table.add_section()
    return result_table


def write_table(path: Path, results: Sequence[Result], order: Sequence[str]) -> None:
    """Write all digits of the results into a CSV file, in which rows of other problems stay.

    Args:
        path: the file; made if it is not there.
        results: of the problems that ran; one that broke off has no rows.
        order: names of all problems, as their rows are ordered.
    """
    rows = _frame(results)
    if path.is_file():
        former = pd.read_csv(path, dtype=str, keep_default_na=False)
        kept = former[~former["scene"].isin([result.name for result in results])]
        rows = pd.concat([kept, rows]) if len(rows) else kept
    if len(rows):
        indices = {name: index for index, name in enumerate(order)}
        rows = rows.sort_values("scene", key=lambda names: names.map(indices), kind="stable")
    rows.to_csv(path, index=False)


def _frame(results: Iterable[Result]) -> pd.DataFrame:
    """One row a comparison."""
    return pd.DataFrame(
        [
            {"scene": result.name, **asdict(check), "passed": check.passed, "wall_time": result.wall_time}
            for result in results
            for check in result.checks
        ]
    )


def _rows(result: Result) -> Iterator[list[str]]:
    wall_time = f"{result.wall_time:.1f}"
    if result.fault:
        yield [result.name, result.fault, "", "", "", "", "", wall_time, "[red]failed[/]"]
    for number, check in enumerate(result.checks):
        first = number == 0
        numbers = [f"{check.measured:.6g}", f"{check.expected:.6g}", f"{check.error:.2g}", _allowed(check)]
        start = [result.name if first else "", check.quantity, check.unit]
        yield [*start, *numbers, wall_time if first else "", _verdict(check)]


def _verdict(check: Check) -> str:
    if check.allowed == inf:
        return ""
    return "ok" if check.passed else "[red]failed[/]"


def _allowed(check: Check) -> str:
    return "shown" if check.allowed == inf else f"{check.allowed:g}"
