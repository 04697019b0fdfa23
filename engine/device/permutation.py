"""Move the entries of fields on the device."""

from collections.abc import Iterable, Iterator, Sequence

import taichi as ti

from engine.device.fields import allocate, components

WIDTH = 24
"""Numbers of an entry that move at once: more in a loop are fewer loops to compile, but take memory."""


@ti.data_oriented
class Permutation:
    """New order of the entries of some fields, which move in groups through the same memory.

    Args:
        fields: of scalars, vectors or matrices; doubles hold their numbers exactly.
        size: most entries.

    Attributes:
        groups: components of the fields that move together.
        source: index at which each entry was before.
        moved: numbers of the entries of one group in their new order.
    """

    def __init__(self, fields: Sequence[ti.Field], size: int) -> None:
        self.groups, self.source = tuple(in_groups(map(components, fields))), allocate(ti.i32, size)
        self.moved = allocate(ti.f64, (size, max(map(len, self.groups))))

    @ti.kernel
    def apply(self, count: ti.i32):
        """Let each of `count` entries receive the one at its source."""
        for group in ti.static(self.groups):
            for p in range(count):
                for i in ti.static(range(len(group))):
                    self.moved[p, i] = ti.cast(group[i][self.source[p]], ti.f64)
            for p in range(count):
                for i in ti.static(range(len(group))):
                    group[i][p] = ti.cast(self.moved[p, i], group[i].dtype)


def in_groups(fields: Iterable[tuple[ti.Field, ...]]) -> Iterator[tuple[ti.Field, ...]]:
    """Return the components of fields, together as long as they are at most `WIDTH`.

    Args:
        fields: components of each, at most `WIDTH`.
    """
    group: tuple[ti.Field, ...] = ()
    for field in fields:
        if len(group) + len(field) > WIDTH:
            yield group
            group = ()
        group += field
    yield group
