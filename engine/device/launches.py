"""Kernels launched one after another, without what Python does at every single launch.

A step of a small scene takes little longer than to launch its kernels in the usual way.
"""

from collections.abc import Callable

from engine.device.taichi_internals import Compiled, compiled, launch

Kernel = Callable[[], None]
"""Kernel of an object, without arguments."""


class Launches:
    """Launch some kernels in order.

    Args:
        kernels: of objects with fields, without arguments.
    """

    def __init__(self, *kernels: Kernel) -> None:
        self.kernels = kernels
        self._compiled: list[Compiled] = []

    def __call__(self) -> None:
        """Launch all once; the first time they are compiled."""
        if not self._compiled:
            self._compiled = [compiled(kernel) for kernel in self.kernels]
        for kernel in self._compiled:
            launch(kernel)
