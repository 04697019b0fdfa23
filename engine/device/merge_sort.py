"""Stable sort on the device: pieces by insertion, then merges of pairs (merge path; Odeh et al. 2012)."""

import taichi as ti

from engine.device.fields import allocate

PIECE = 32
"""Entries that one thread sorts, and merges."""


@ti.data_oriented
class MergeSort:
    """Keys in ascending order, each with a value.

    Every thread merges one piece of a pair of runs; bisection tells it which part of both that is.

    Args:
        size: most entries.

    Attributes:
        key, value: of every entry, shape [2, size]; those of `side` are current.
        side: 0 or 1.
    """

    def __init__(self, size: int) -> None:
        self.key, self.value, self.side = allocate(ti.i64, (2, size)), allocate(ti.i32, (2, size)), 0

    def sort(self, count: int, piece: int = PIECE, segment: int | None = None) -> None:
        """Sort the entries, or every segment of them.

        Args:
            count: number of entries.
            piece: entries of a piece.
            segment: entries of a segment, `piece` times a power of two, of which `count` is a multiple; all if `None`.
        """
        self.sort_pieces(self.side, count, piece)
        run = piece
        while run < (segment or count):
            self.merge_runs(self.side, count, piece, run)
            self.side, run = 1 - self.side, 2 * run

    @ti.kernel
    def sort_pieces(self, side: ti.i32, count: ti.i32, piece: ti.i32):
        """Sort every piece by insertion."""
        for i in range((count + piece - 1) // piece):
            for k in range(i * piece + 1, ti.min((i + 1) * piece, count)):
                key, value, place = self.key[side, k], self.value[side, k], k
                while place > i * piece and self.key[side, ti.max(place - 1, 0)] > key:
                    self.put(side, place, self.key[side, place - 1], self.value[side, place - 1])
                    place -= 1
                self.put(side, place, key, value)

    @ti.kernel
    def merge_runs(self, side: ti.i32, count: ti.i32, piece: ti.i32, run: ti.i32):
        """Merge every pair of sorted runs into the other side."""
        for i in range((count + piece - 1) // piece):
            first = i * piece // (2 * run) * (2 * run)
            middle, last = ti.min(first + run, count), ti.min(first + 2 * run, count)
            a = self.part_of_first(side, first, middle, last, i * piece - first)
            b = middle + i * piece - a
            for k in range(i * piece, ti.min((i + 1) * piece, last)):
                from_first = b >= last
                if a < middle and b < last:
                    from_first = self.key[side, a] <= self.key[side, b]
                if from_first:
                    self.put(1 - side, k, self.key[side, a], self.value[side, a])
                    a += 1
                else:
                    self.put(1 - side, k, self.key[side, b], self.value[side, b])
                    b += 1

    @ti.func
    def part_of_first(self, side, first, middle, last, merged):
        """Return the end of that part of the run `first` to `middle` that is among the first `merged` of a pair."""
        low, high = ti.max(first, first + merged - (last - middle)), ti.min(middle, first + merged)
        while low < high:
            half = (low + high) // 2
            if self.key[side, half] <= self.key[side, middle + first + merged - 1 - half]:
                low = half + 1
            else:
                high = half
        return low

    @ti.func
    def put(self, side, k, key, value):
        """Set an entry."""
        self.key[side, k], self.value[side, k] = key, value
