"""Running verification problems one after the other, and their results as a table."""

import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from math import inf

import pandas as pd
from rich.table import Table

from engine.device import backend
from engine.errors import RunFault
from engine.verification.check import Check, Problem


@dataclass(frozen=True)
class Result:
    """What one problem reported.

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
    """Results of the problems, each in a fresh Taichi program."""
    for problem in problems:
        backend.start(arch, threads)
        begun = time.monotonic()
        try:
            checks, fault = problem.checks(), ""
        except RunFault as error:
            checks, fault = [], str(error)
        yield Result(problem.name, checks, time.monotonic() - begun, fault)


def table(results: Iterable[Result]) -> Table:
    """Scene, quantity, measured, expected, error, allowed and run time."""
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


def frame(results: Iterable[Result]) -> pd.DataFrame:
    """One row per comparison; a problem that broke off has none."""
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
    return "reported" if check.allowed == inf else f"{check.allowed:g}"
