"""Sums over particles in a fixed order: of chunks, then over the chunks. The same numbers give the same bits."""

from collections.abc import Callable
from typing import Any

import numpy as np
import taichi as ti
from numpy.typing import NDArray

from engine.device.fields import allocate, capacity
from engine.device.prefix_sum import CHUNK


@ti.data_oriented
class FixedOrderSum:
    """Sum of a vector over some entries, in double precision.

    Args:
        summand: device function that returns the vector of an entry; it is called once for each.
        width: length of the vector.
        size: most entries.
    """

    def __init__(self, summand: Callable[..., Any], width: int, size: int) -> None:
        self.summand, self.vector = summand, ti.types.vector(width, ti.f64)
        self.of_chunk, self.total = allocate(self.vector, capacity(size) // CHUNK), allocate(self.vector)

    def over(self, count: int) -> NDArray[np.float64]:
        """Return the sum over the first `count` entries, shape [width]."""
        self.run(count)
        return np.asarray(self.total.to_numpy())

    @ti.kernel
    def run(self, count: ti.i32):
        """Sum the chunks, then over them."""
        chunks = (count + CHUNK - 1) // CHUNK
        for c in range(chunks):
            total = self.vector(0.0)
            for k in range(c * CHUNK, ti.min((c + 1) * CHUNK, count)):
                total += self.summand(k)
            self.of_chunk[c] = total
        ti.loop_config(serialize=True)
        for _ in range(1):
            total = self.vector(0.0)
            for c in range(chunks):
                total += self.of_chunk[c]
            self.total[None] = total
