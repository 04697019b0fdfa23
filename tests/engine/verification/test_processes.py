"""Work in processes of their own."""

import os
from concurrent.futures.process import BrokenProcessPool

import pytest

from engine.device.options import chosen
from engine.verification.processes import in_own_process


def test_a_process_has_a_precision_of_its_own() -> None:
    assert in_own_process("f32", chosen) == "f32" and chosen() == "f64"


def test_a_process_that_dies_is_told_by_an_exception() -> None:
    with pytest.raises(BrokenProcessPool):
        in_own_process("f64", os.abort)
