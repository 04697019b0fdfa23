"""All measurements of gravity: `python -m tests.benchmarks.gravity` writes figures as JSON, tables and an image."""

import json
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any

import typer

from tests.benchmarks.child import ask
from tests.benchmarks.gravity.figure import draw
from tests.benchmarks.gravity.states import LATE, PER_BODY, SPHERE, save, sphere
from tests.benchmarks.gravity.tables import print_tables
from tests.benchmarks.host import commit, host

COUNTS = (10_000, 30_000, 100_000, 300_000, 1_000_000)
INTERVALS = (5.0, 10.0, 20.0, 40.0, 80.0)
PEERS = ("pytreegrav", "numba", "rebound")

Results = dict[str, Any]


def main(out: Annotated[Path, typer.Option(help="Directory of all results.")] = Path("runs/bench-gravity")) -> None:
    """Compare gravity with other codes, and measure its share of a run, its scaling and what it conserves."""
    out = out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    states = {LATE: out / "late-collision.npz", SPHERE: out / "uniform-sphere.npz"}
    save(sphere(2 * PER_BODY), states[SPHERE])
    results = {
        "date": datetime.now(UTC).date().isoformat(),
        "commit": commit(),
        "host": host(),
        "peers": {name: version(name) for name in PEERS},
        "particles": 2 * PER_BODY,
        "run": _tell("late", directory=str(out / "late"), state=str(states[LATE])),
        "curves": {name: _tell("curve", state=str(path))["lines"] for name, path in states.items()},
        "scaling": [_tell("scaling", count=count) for count in COUNTS],
        "intervals": [
            _tell("interval", interval=interval, corrected=corrected)
            for corrected in (True, False)
            for interval in INTERVALS
        ],
    }
    (out / "gravity.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    draw(results["curves"], out / "gravity.png")
    print_tables(results)
    print(f"written to {out}")


def _tell(module: str, **arguments: Any) -> Results:
    typer.echo(f"{module} {arguments}", err=True)
    return ask(f"gravity.{module}", **arguments)


if __name__ == "__main__":
    typer.run(main)
