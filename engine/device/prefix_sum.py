"""Running sums on the device: of chunks, over the chunks, and within them."""

import taichi as ti

from engine.device.fields import allocate

CHUNK = 256
"""Entries that one thread sums."""

pair = ti.types.vector(2, ti.i32)


@ti.data_oriented
class PrefixSum:
    """Sums of two integers over all entries before each.

    Args:
        size: most entries.

    Attributes:
        before: two integers for each entry; after `run` the sums over the entries before it, at `count` over all.
    """

    def __init__(self, size: int) -> None:
        self.before, self.of_chunk = allocate(pair, size + 1), allocate(pair, size // CHUNK + 1)

    @ti.kernel
    def run(self, count: ti.i32):
        """Replace the integers of `count` entries by the sums before them."""
        chunks = (count + CHUNK - 1) // CHUNK
        for c in range(chunks):
            total = pair(0)
            for k in range(c * CHUNK, ti.min((c + 1) * CHUNK, count)):
                total += self.before[k]
            self.of_chunk[c] = total
        ti.loop_config(serialize=True)
        for _ in range(1):
            total = pair(0)
            for c in range(chunks):
                own = self.of_chunk[c]
                self.of_chunk[c] = total
                total += own
            self.before[count] = total
        for c in range(chunks):
            total = self.of_chunk[c]
            for k in range(c * CHUNK, ti.min((c + 1) * CHUNK, count)):
                own = self.before[k]
                self.before[k] = total
                total += own
