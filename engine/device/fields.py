"""Fields on the device: their sizes, and their contents from arrays of the host."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.device.backend import Real
from engine.device.taichi_internals import to_numpy_type


def capacity(count: int) -> int:
    """Size of a field for `count` entries: few sizes, so that scenes of many sizes share compiled kernels."""
    return max(1024, 1 << (count - 1).bit_length())


def filled(dtype: Any, values: NDArray[Any]) -> ti.Field:
    """Return a one-dimensional field that begins with `values`; the rest is zero."""
    field = ti.field(dtype, shape=capacity(len(values)))
    overwrite(field, values)
    return field


def overwrite(field: Any, values: NDArray[Any]) -> None:
    """Fill the first entries of a field with `values`, and the rest with zeros."""
    padded = np.zeros((field.shape[0], *values.shape[1:]), dtype=to_numpy_type(field.dtype))
    padded[: len(values)] = values
    field.from_numpy(padded)


def per_body(**columns: Sequence[float]) -> Any:
    """Return a field of structs of constants, one entry per body.

    Args:
        columns: values of each member of the struct, one per body.
    """
    table = ti.types.struct(**dict.fromkeys(columns, Real)).field(shape=len(next(iter(columns.values()))))
    for name, values in columns.items():
        for body, value in enumerate(values):
            getattr(table, name)[body] = value
    return table
