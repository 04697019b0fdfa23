"""Memory of a simulation: what its particles and grid occupy, and what a step moves at least."""

from engine.device.taichi_internals import StructField
from engine.mpm.stencil import COPY
from engine.profile.parts import allocated_bytes, entry_bytes, name_in_tuple, own_fields
from engine.simulation.simulation import Simulation

TOUCHED = {
    "kick": ("x tau acceleration mass body", "x mass v C", "v C kicked"),
    "drift": ("x v C j E origin transfer_heat", "x C E transfer_heat"),
    "projection": (
        "x mass v C",
        "x mass v C body acceleration b_minus_I j E damage_root tau plastic_heat viscous_heat",
        "remainder b_minus_I j E half_step_work damage_root tau plastic_heat viscous_heat",
    ),
    "correction": ("x mass remainder", "x mass remainder kicked v C E transfer_heat", "v C E transfer_heat"),
}
"""Fields of a particle that a stage reads to the grid and from the grid, and those that it writes."""
GRID_TRIPS = 4
"""Times that every node copy crosses the caches in a pass: filled, summed, written, read; clearing stays in cache."""


def bytes_per_step(simulation: Simulation) -> float:
    """Least traffic of one step with memory, per particle, when nothing stays in cache from kernel to kernel."""
    stencil, stages = simulation.stencil, [name_in_tuple(stage) for stage in simulation.transfer.stages]
    fields = {**own_fields(simulation.particles), **motions(simulation)}
    names = " ".join(" ".join(TOUCHED[stage]) for stage in stages).split()
    state = sum(entry_bytes(fields[name]) for name in names if name in fields)
    copies = sum(stage != "drift" for stage in stages) * int(stencil.block_count[None]) * COPY
    return state + GRID_TRIPS * copies * entry_bytes(stencil.nodes) / simulation.particles.count


def motions(simulation: Simulation) -> dict[str, StructField]:
    """Fields in which the transfer scheme keeps motions of every particle from stage to stage."""
    return {name: field for name, field in own_fields(simulation.scheme).items() if isinstance(field, StructField)}


def allocated(simulation: Simulation) -> dict[str, float]:
    """Bytes per particle of its state with its flaws, allocated and in use, and of the grid.

    Fields have room for a power of two of entries, so what is allocated per particle jumps by two.
    """
    particles, stencil, fracture = simulation.particles, simulation.stencil, simulation.constitution.damage.fracture
    count = particles.count
    per_particle = [*own_fields(particles).values(), *motions(simulation).values(), stencil.owner]
    flaws = [fracture.first, fracture.strain]
    used = sum(map(entry_bytes, [*per_particle, fracture.first])) * count
    used += int(fracture.first[count]) * entry_bytes(fracture.strain)
    grid = [field for name, field in own_fields(stencil).items() if name != "owner"]
    return {
        "state": sum(map(allocated_bytes, [*per_particle, *flaws])) / count,
        "state_used": used / count,
        "grid": sum(map(allocated_bytes, grid)) / count,
    }
