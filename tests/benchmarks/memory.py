"""Memory of a simulation: what its particles and grid occupy, and what a step moves at least."""

from engine.mpm.stencil import COPY
from engine.profile.parts import allocated_bytes, entry_bytes, own_fields
from engine.simulation.simulation import Simulation

PARTICLES_TO_GRID = ("x", "v", "C", "tau", "acceleration", "mass", "body")
"""Particle fields read."""
GRID_TO_PARTICLES = ("x", "origin", "mass", "body", "acceleration", "b_minus_I", "j", "E", "damage_root", "tau")
UPDATED = ("x", "v", "C", "b_minus_I", "j", "E", "damage_root", "tau")
"""Particle fields written."""
GRID_PASSES = 4
"""Times that every node copy crosses the caches: filled, summed, written back, read; clearing stays in cache."""


def bytes_per_step(simulation: Simulation) -> float:
    """Least traffic of one step with memory, per particle, when nothing stays in cache from kernel to kernel."""
    particles, stencil = simulation.particles, simulation.stencil
    names = [name for name in (*PARTICLES_TO_GRID, *GRID_TO_PARTICLES, *UPDATED) if name in particles.allocated]
    state = sum(entry_bytes(getattr(particles, name)) for name in names)
    copies = int(stencil.block_count[None]) * COPY
    return state + GRID_PASSES * copies * entry_bytes(stencil.nodes) / particles.count


def allocated(simulation: Simulation) -> dict[str, float]:
    """Bytes per particle of its state with its flaws, allocated and in use, and of the grid.

    Fields have room for a power of two of entries, so what is allocated per particle jumps by two.
    """
    particles, stencil, fracture = simulation.particles, simulation.stencil, simulation.constitution.damage.fracture
    count = particles.count
    per_particle = [*own_fields(particles).values(), stencil.owner]
    flaws = [fracture.first, fracture.strain]
    used = sum(map(entry_bytes, [*per_particle, fracture.first])) * count
    used += int(fracture.first[count]) * entry_bytes(fracture.strain)
    grid = [field for name, field in own_fields(stencil).items() if name != "owner"]
    return {
        "state": sum(map(allocated_bytes, [*per_particle, *flaws])) / count,
        "state_used": used / count,
        "grid": sum(map(allocated_bytes, grid)) / count,
    }
