"""Move the entries of fields on the device."""

from collections.abc import Sequence

import taichi as ti

from engine.device.fields import allocate, components


@ti.data_oriented
class Permutation:
    """New order of the entries of some fields, which move one after another through the same memory.

    Args:
        fields: of scalars, vectors or matrices; doubles hold their numbers exactly.
        size: most entries.

    Attributes:
        source: index at which each entry was before.
        moved: numbers of the entries of one field in their new order.
    """

    def __init__(self, fields: Sequence[ti.Field], size: int) -> None:
        self.fields, self.source = tuple(map(components, fields)), allocate(ti.i32, size)
        self.moved = allocate(ti.f64, (size, max(map(len, self.fields))))

    @ti.kernel
    def apply(self, count: ti.i32):
        """Let each of `count` entries receive the one at its source."""
        for field in ti.static(self.fields):
            for p in range(count):
                for i in ti.static(range(len(field))):
                    self.moved[p, i] = ti.cast(field[i][self.source[p]], ti.f64)
            for p in range(count):
                for i in ti.static(range(len(field))):
                    field[i][p] = ti.cast(self.moved[p, i], field[i].dtype)
