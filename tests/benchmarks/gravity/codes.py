"""Gravity of this project and of others behind one face; the others are imported only when asked for."""

import ctypes
from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.constants import G_NEWTON
from engine.gravity.barnes_hut import BarnesHut
from engine.gravity.direct_sum import DirectSum
from tests.benchmarks.gravity.states import State
from tests.helpers.gravity import accelerations
from tests.helpers.monopoles import Monopoles

Pull = NDArray[np.float64]
GROUP = 16
"""Particles that walk pytreegrav's tree together: of 4 to 32 the fastest here at equal error (its default is 8)."""


class Code(ABC):
    """One code on one state."""

    @abstractmethod
    def exact(self) -> Pull:
        """Accelerations [m/s^2] as a sum over all pairs with the code's own softening, shape [particle_count, 3]."""

    @abstractmethod
    def evaluate(self, opening: float) -> Pull:
        """The same through the tree, which is built anew."""


class Ours(Code):
    """The engine's tree, from particles on the device to accelerations on the host; Taichi must have been started."""

    def __init__(self, state: State, quadrupole: bool) -> None:
        self.particles, self.radius = state.particles(), state.radius
        self.tree = (BarnesHut if quadrupole else Monopoles)(self.particles, self.radius, 1.0)

    def exact(self) -> Pull:
        return accelerations(DirectSum(self.particles, self.radius))

    def evaluate(self, opening: float) -> Pull:
        self.tree.opening[None] = opening
        return accelerations(self.tree)


class PyTreeGrav(Code):
    """pytreegrav (Grudic & Gurvich 2021): an octree in numba; the kernel is a cubic spline of the same support."""

    def __init__(self, state: State, quadrupole: bool) -> None:
        import pytreegrav

        self.accelerate: Any = pytreegrav.Accel
        self.given = (state.x, state.mass, np.full(len(state.x), state.radius))
        self.quadrupole = quadrupole

    def exact(self) -> Pull:
        return np.asarray(self.accelerate(*self.given, method="bruteforce", G=G_NEWTON))

    def evaluate(self, opening: float) -> Pull:
        options = {"theta": opening, "quadrupole": self.quadrupole, "group_size": GROUP}
        return np.asarray(self.accelerate(*self.given, method="tree", G=G_NEWTON, **options))


class Rebound(Code):
    """rebound (Rein & Liu 2012), as its wheel has it: an octree of monopoles on one thread; Plummer's kernel."""

    def __init__(self, state: State, quadrupole: bool) -> None:
        import rebound

        assert not quadrupole
        self.fields = rebound.Particle
        self.update = rebound.clibrebound.reb_simulation_update_acceleration
        self.update.argtypes, self.update.restype = [ctypes.c_void_p], None
        x = state.x - state.x.mean(axis=0)
        self.simulation = rebound.Simulation()
        self.simulation.G, self.simulation.softening = G_NEWTON, state.radius
        self.simulation.root_size = 2.2 * float(np.abs(x).max())
        for (px, py, pz), mass in zip(x.tolist(), state.mass.tolist(), strict=True):
            self.simulation.add(rebound.Particle(m=mass, x=px, y=py, z=pz))

    def exact(self) -> Pull:
        return self._pull("basic")

    def evaluate(self, opening: float) -> Pull:
        self.simulation.opening_angle2 = opening**2
        return self._pull("tree")

    def _pull(self, gravity: str) -> Pull:
        self.simulation.gravity = gravity
        self.update(ctypes.byref(self.simulation))
        size, count = ctypes.sizeof(self.fields), self.simulation.N
        memory = (ctypes.c_char * (count * size)).from_address(ctypes.addressof(self.simulation._particles.contents))
        records = np.frombuffer(memory, dtype=np.uint8).reshape(count, size)
        offsets = [getattr(self.fields, name).offset for name in ("ax", "ay", "az")]
        return np.stack([records[:, o : o + 8].copy().view(np.float64)[:, 0] for o in offsets], axis=1)


CODES: dict[str, type[Code]] = {"this project": Ours, "pytreegrav": PyTreeGrav, "rebound": Rebound}
