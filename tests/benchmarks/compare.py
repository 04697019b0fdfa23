"""Two versions of the engine, in turns: `python -m tests.benchmarks.compare BASE`."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from tests.benchmarks import laps
from tests.benchmarks.child import ROOT

SECONDS = {"before contact": -1e5, "100 s after": 100.0}
"""States that are timed: simulated time [s] after contact."""
LEAST_CHANGE = 0.1
"""Change of the CPU time of a step that is marked."""


class Version:
    """A process of one version that steps when asked.

    Args:
        root: its checkout.
        arguments: of tests/benchmarks/laps.py.
    """

    def __init__(self, root: Path, **arguments: float) -> None:
        command = [sys.executable, "-P", str(Path(laps.__file__)), json.dumps(arguments)]
        environment = {**os.environ, "PYTHONPATH": str(root)}
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, cwd=root, env=environment, stdin=pipe, stdout=pipe, text=True)
        self.start = self._read()["start"]

    def lap(self) -> float:
        """Return the CPU time [s] of a step, the mean over some."""
        assert self.process.stdin
        print(file=self.process.stdin, flush=True)
        return float(self._read()["cpu"])

    def end(self) -> None:
        """Let the process end."""
        self.process.communicate()

    def _read(self) -> dict[str, Any]:
        assert self.process.stdout
        for line in self.process.stdout:
            if line.startswith("{"):
                return dict(json.loads(line))
        raise SystemExit(f"{self.process.args}: ended with exit code {self.process.wait()}")


@contextmanager
def checkout(commit: str) -> Iterator[Path]:
    """A checkout of a commit, for as long as it is used."""
    with tempfile.TemporaryDirectory() as directory:
        root = Path(directory) / "base"
        _git("worktree", "add", "--detach", "--quiet", str(root), commit)
        try:
            yield root
        finally:
            _git("worktree", "remove", "--force", str(root))


def main(
    base: Annotated[str, typer.Argument(help="Commit to compare with.")],
    particles: Annotated[int, typer.Option(min=1, help="Particles of each body.")] = 20_000,
    threads: Annotated[int, typer.Option(min=1, help="CPU threads of each version.")] = 1,
    rounds: Annotated[int, typer.Option(min=1, help="Laps of each version.")] = 12,
    steps: Annotated[int, typer.Option(min=1, help="Steps of a lap.")] = 10,
) -> None:
    """Time the steps of BASE and of the present code, lap by lap in turns, and tell their ratio."""
    table = Table("state", "start [s]", "ms per step, CPU", "present / base", "", title=f"{base} and the present code")
    with checkout(base) as root:
        for state, seconds in SECONDS.items():
            told = {"particles": particles, "threads": threads, "seconds": seconds, "steps": steps}
            versions = [Version(tree, **told) for tree in (root, ROOT)]
            table.add_row(state, *row(versions, rounds))
            for version in versions:
                version.end()
    Console().print(table)


def row(versions: list[Version], rounds: int) -> tuple[str, ...]:
    """Return starts, median times, median and quartiles of their ratio, and whether it is a change.

    Args:
        versions: base and present.
        rounds: laps of each, in turns.
    """
    times = np.empty((rounds, 2))
    for turn in range(rounds):
        for side in (0, 1) if turn % 2 == 0 else (1, 0):  # each goes first as often
            times[turn, side] = 1e3 * versions[side].lap()
    low, ratio, high = np.quantile(times[:, 1] / times[:, 0], (0.25, 0.5, 0.75))
    verdict = ("slower" if ratio > 1.0 else "faster") if abs(ratio - 1.0) > LEAST_CHANGE else "no change"
    starts = ", ".join(f"{version.start:.1f}" for version in versions)
    medians = ", ".join(f"{time:.2f}" for time in np.median(times, axis=0))
    return starts, medians, f"{ratio:.2f} ({low:.2f} to {high:.2f})", verdict


def _git(*arguments: str) -> None:
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"git {arguments[0]}: {done.stderr.strip()}")


if __name__ == "__main__":
    typer.run(main)
