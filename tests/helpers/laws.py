"""`python -m tests.helpers.laws`: every law with the largest error its tests find, and how many inputs they try."""

import sys
from pathlib import Path

import pytest

from tests.helpers.device import COMPARED

TESTS = Path(__file__).parents[1] / "engine"

LAWS = {
    "tensors": "logarithms, eigenvalues",
    "shear": "deformation",
    "tillotson": "Tillotson pressure",
    "algebraic": "Murnaghan pressure",
    "strength": "strength",
    "fracture": "damage",
    "viscosity": "viscosity",
    "constitution": "all laws of a particle",
    "bar": "bar of breaking particles",
    "direct_sum": "sum over pairs",
    "self_gravity": "gravity of a sphere",
    "transfer": "whole step",
}
"""Test modules of the laws, in the order of engine/physics.md."""


def row(test: str, inputs: int, error: float) -> str:
    """One line of the table, from a test's path and name."""
    path, name = test.split("::")
    law = LAWS[Path(path).stem.removeprefix("test_")]
    return f"| {law} | {name.removeprefix('test_').replace('_', ' ')} | {inputs:,} | {error:.1e} |"


def main() -> int:
    """Run the laws' tests and print the table; the exit code is that of the tests."""
    code = pytest.main([str(next(TESTS.rglob(f"test_{law}.py"))) for law in LAWS])
    print("\n| law | what is tested | inputs | largest error |\n|---|---|---|---|")
    for test, (inputs, error) in COMPARED.items():
        print(row(test, inputs, error))
    return int(code)


if __name__ == "__main__":
    sys.exit(main())
