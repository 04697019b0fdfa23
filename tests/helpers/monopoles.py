"""A tree of masses alone, to compare orders of expansion."""

from typing import Any

import taichi as ti

from engine.gravity.barnes_hut import BarnesHut


@ti.data_oriented
class Monopoles(BarnesHut):
    """A tree whose nodes act without their quadrupoles, which are still computed; arguments as `Multipoles`."""

    def build(self) -> Any:
        """All nodes, then no quadrupoles."""
        super().build()
        self.quadrupole.fill(0.0)
