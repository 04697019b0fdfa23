"""Faults and errors in words."""

import errno
import math
from pathlib import Path

import pytest

from engine.errors import Fault, GuardFault, in_words, stop


def test_a_fault_says_what_is_out_of_bounds_where_and_what_to_try() -> None:
    fault = stop("speed [m/s]", 1234.5678, "at most 100", 3.0, 7, advice="slow down").fault
    assert str(fault) == "speed [m/s] of particle 7 is 1234.57 at t = 3 s, allowed: at most 100; slow down"


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_value_that_is_not_finite_is_none_so_that_json_can_hold_it(value: float) -> None:
    caught = stop("total mass [kg]", value, "finite", 0.0, advice="look closer")
    assert isinstance(caught, GuardFault) and caught.fault.value is None
    assert str(caught) == "total mass [kg] is not finite at t = 0 s, allowed: finite; look closer"
    assert caught.fault == Fault("total mass [kg]", None, "finite", 0.0, None, "look closer")


def test_an_error_of_the_system_names_its_file_or_the_one_it_is_told() -> None:
    full = OSError(errno.ENOSPC, "No space left on device", "final.nc")
    assert in_words(full, Path("job")) == "final.nc: No space left on device"
    assert in_words(OSError(errno.EIO, "Input/output error"), Path("job")) == "job: Input/output error"
    assert in_words(OSError("netCDF: trouble")) == "netCDF: trouble"
