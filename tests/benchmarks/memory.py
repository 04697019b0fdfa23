"""Memory of a simulation: what its particles and grid occupy, and what a step moves at least."""

from collections.abc import Iterable, Iterator
from math import prod
from typing import Any

import numpy as np
import taichi as ti
from taichi.lang.util import to_numpy_type

from engine.simulation import Simulation
from engine.transfer import COPY

PARTICLES_TO_GRID = ("x", "v", "C", "tau", "acceleration", "mass", "body")
"""Particle fields read."""
GRID_TO_PARTICLES = ("x", "origin", "mass", "body", "acceleration", "B", "j", "E", "root", "tau")
UPDATED = ("x", "v", "C", "B", "j", "E", "root", "tau")
"""Particle fields written."""
GRID_PASSES = 4
"""Times that every node copy crosses the caches: filled, summed, written back, read; clearing stays in cache."""


def bytes_per_step(simulation: Simulation) -> float:
    """Least traffic of one step with memory, per particle, when nothing stays in cache from kernel to kernel."""
    particles, transfer = simulation.particles, simulation.transfer
    names = (*PARTICLES_TO_GRID, *GRID_TO_PARTICLES, *UPDATED)
    state = sum(_entry_bytes(getattr(particles, name)) for name in names)
    state += 2 * _entry_bytes(transfer.order)
    copies = int(transfer.block_count[None]) * COPY
    return state + GRID_PASSES * copies * _entry_bytes(transfer.nodes) / particles.count


def allocated(simulation: Simulation) -> dict[str, float]:
    """Bytes per particle of its state with its flaws, allocated and in use, and of the grid.

    Fields have room for a power of two of entries, so what is allocated per particle jumps by two.
    """
    particles, transfer, fracture = simulation.particles, simulation.transfer, simulation.constitution.fracture
    count = particles.count
    per_particle = [*_fields(particles), transfer.order, transfer.owner]
    flaws = [fracture.first, fracture.strain]
    used = sum(map(_entry_bytes, [*per_particle, fracture.first])) * count
    used += int(fracture.first[count]) * _entry_bytes(fracture.strain)
    grid = [field for field in _fields(transfer) if field is not transfer.order and field is not transfer.owner]
    return {
        "state": _bytes([*per_particle, *flaws]) / count,
        "state_used": used / count,
        "grid": _bytes(grid) / count,
    }


def _fields(owner: Any) -> Iterator[Any]:
    return (value for value in vars(owner).values() if isinstance(value, ti.Field))


def _bytes(fields: Iterable[Any]) -> int:
    return sum(prod(field.shape) * _entry_bytes(field) for field in fields)


def _entry_bytes(field: Any) -> int:
    """Size of one entry of a field."""
    components = getattr(field, "n", 1) * getattr(field, "m", 1)
    return int(components * np.dtype(to_numpy_type(field.dtype)).itemsize)
