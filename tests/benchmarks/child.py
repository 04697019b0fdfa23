"""Measurements in processes of their own: a process holds one Taichi program, on one number of threads."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from engine.device.options import VARIABLE, Precision

ROOT = Path(__file__).parents[2]


def ask(module: str, precision: Precision = "f64", **arguments: float | str) -> dict[str, Any]:
    """The answer of tests/benchmarks/`module`, run with these arguments in this precision."""
    command = [sys.executable, "-m", f"tests.benchmarks.{module}", json.dumps(arguments)]
    environment = {**os.environ, VARIABLE: precision}
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True, env=environment)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def answer(measure: Callable[..., dict[str, Any]]) -> None:
    """Print what `measure` returns for the arguments on the command line."""
    print(json.dumps(measure(**json.loads(sys.argv[1]))))
