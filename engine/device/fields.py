"""Fields on the device: their sizes, and their contents from arrays of the host."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.device.backend import Real
from engine.device.taichi_internals import StructField, to_numpy_type


def capacity(count: int) -> int:
    """Return the size of a field for `count` entries: a power of two, at least 1024.

    With few sizes of fields, scenes of many sizes use the same compiled kernels.
    """
    return max(1024, 1 << (count - 1).bit_length())


def filled(dtype: Any, values: NDArray[np.generic]) -> ti.Field:
    """Return a one-dimensional field that begins with given values; the rest is zero.

    Args:
        dtype: Taichi's type of an entry.
        values: shape [count].
    """
    field = ti.field(dtype, shape=capacity(len(values)))
    overwrite(field, values)
    return field


def overwrite(field: ti.Field, values: NDArray[np.generic]) -> None:
    """Fill the first entries of a field with given values, and the rest with zeros.

    Args:
        field: of scalars, vectors or matrices.
        values: shape [count], followed by that of an entry.
    """
    padded = np.zeros((field.shape[0], *values.shape[1:]), dtype=to_numpy_type(field.dtype))
    padded[: len(values)] = values
    field.from_numpy(padded)


def per_body(**columns: Sequence[float]) -> StructField:
    """Return a field of structs of constants, one entry per body, with room for more as in every other field.

    Args:
        columns: values of each member of the struct, one per body.
    """
    table = ti.types.struct(**dict.fromkeys(columns, Real)).field(shape=capacity(len(next(iter(columns.values())))))
    for name, values in columns.items():
        for body, value in enumerate(values):
            getattr(table, name)[body] = value
    return table
