"""Move the entries of fields on the device."""

from collections.abc import Sequence

import taichi as ti

from engine.device.fields import allocate, rank

MOST_COMPONENTS = 9


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
        self.fields, self.source = tuple(fields), allocate(ti.i32, size)
        self.moved = allocate(ti.f64, (size, MOST_COMPONENTS))

    @ti.kernel
    def apply(self, count: ti.i32):
        """Let each of `count` entries receive the one at its source."""
        for field in ti.static(self.fields):
            for p in range(count):
                self.keep(field, p)
            for p in range(count):
                self.receive(field, p)

    @ti.func
    def keep(self, field: ti.template(), p):
        """Copy the entry that index p receives."""
        entry = field[self.source[p]]
        if ti.static(rank(field) == 0):
            self.moved[p, 0] = ti.cast(entry, ti.f64)
        elif ti.static(rank(field) == 1):
            for i in ti.static(range(field.n)):
                self.moved[p, i] = ti.cast(entry[i], ti.f64)
        else:
            for i, j in ti.static(ti.ndrange(field.n, field.m)):
                self.moved[p, i * field.m + j] = ti.cast(entry[i, j], ti.f64)

    @ti.func
    def receive(self, field: ti.template(), p):
        """Set the entry at index p to its copy."""
        if ti.static(rank(field) == 0):
            field[p] = ti.cast(self.moved[p, 0], field.dtype)
        elif ti.static(rank(field) == 1):
            for i in ti.static(range(field.n)):
                field[p][i] = ti.cast(self.moved[p, i], field.dtype)
        else:
            for i, j in ti.static(ti.ndrange(field.n, field.m)):
                field[p][i, j] = ti.cast(self.moved[p, i * field.m + j], field.dtype)
