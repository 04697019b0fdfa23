"""Fields on the device: their sizes, and their contents from arrays of the host."""

from collections.abc import Sequence
from functools import partial
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


def allocate(kind: Any, shape: int | tuple[int, ...] = ()) -> ti.Field:
    """Return a new field that takes a multiple of 8 bytes.

    A kernel for Vulkan looks for a number of 8 bytes at the next lower multiple of 8, so none may lie behind an odd
    number of those with 4 bytes.

    Args:
        kind: Taichi's type of an entry.
        shape: its size, as of an array; one more if the first is odd.
    """
    make = kind.field if hasattr(kind, "field") else partial(ti.field, kind)
    if shape == ():
        make(shape=())  # the other half of 8 bytes
        return make(shape=())
    first, *others = (shape,) if isinstance(shape, int) else shape
    return make(shape=(first + first % 2, *others))


def components(field: ti.Field) -> tuple[ti.Field, ...]:
    """Return the components of a field of scalars, vectors or matrices, row by row, each as a field of scalars."""
    rank = getattr(field, "ndim", 0)
    if rank == 0:
        return (field,)
    indices = np.ndindex((field.n, field.m)[:rank])
    return tuple(field.get_scalar_field(*index) for index in indices)


def filled(dtype: Any, values: NDArray[np.generic]) -> ti.Field:
    """Return a one-dimensional field that begins with given values; the rest is zero.

    Args:
        dtype: Taichi's type of an entry.
        values: shape [count].
    """
    field = allocate(dtype, capacity(len(values)))
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
    table = allocate(ti.types.struct(**dict.fromkeys(columns, Real)), capacity(len(next(iter(columns.values())))))
    for name, values in columns.items():
        for body, value in enumerate(values):
            getattr(table, name)[body] = value
    return table
