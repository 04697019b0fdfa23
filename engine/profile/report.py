"""Tables of the parts of a scene, their memory and their time: `python -m engine explain SCENE`."""

from itertools import chain, repeat, zip_longest

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from engine.profile.cost import Cost, Measurement
from engine.profile.parts import Part, allocated_bytes, parts_of


def report(result: Measurement) -> RenderableType:
    """Return a table of the parts of a measured scene, with memory [bytes] and time [ms per step]."""
    simulation, physics = result.simulation, result.simulation.scene.physics
    heading = (
        f"{simulation.particles.count:,} particles in {int(simulation.stencil.block_count[None]):,} blocks; "
        f"{result.steps} steps measured from t = {result.begun:.6g} s on, "
        f"{_per_step(result, result.whole.wall):.3f} ms each (CPU time {_per_step(result, result.whole.cpu):.3f} ms)"
    )
    left_out = ", ".join(name for name, value in physics if not value)
    return Group(
        Text(heading),
        _table(result),
        Text("Parts without kernels run inside those of the stages of a step. Memory is what is allocated."),
        Text(f"Left out, so neither allocated, nor compiled, nor run: {left_out or 'nothing'}."),
    )


def _table(result: Measurement) -> Table:
    """Fields of each part by their size on the left, its kernels on the right."""
    table = Table("part", "is a", "fields", "memory", "kernels", "calls", "ms per step", "CPU")
    for column in table.columns[3:4] + table.columns[5:]:
        column.justify = "right"
    parts = [part for part in parts_of(result.simulation) if not part.is_empty]
    for part in parts:
        lines = zip_longest(_memory(part), _kernels(result, part), fillvalue=())
        names = chain([(part.name, type(part.content).__name__)], repeat(("", "")))
        for name, (fields, kernel) in zip(names, lines, strict=False):
            table.add_row(*name, *(fields or ("", "")), *kernel)
        table.add_section()
    kernels = result.kernels.values()
    host = Cost(0, result.whole.wall - sum(c.wall for c in kernels), result.whole.cpu - sum(c.cpu for c in kernels))
    total = size(sum(allocated_bytes(value) for part in parts for value in part.fields.values()))
    table.add_row("between kernels", "", "what the host does", "", "", "", *_times(result, host))
    table.add_row("total", "", "", total, "", "", *_times(result, result.whole))
    return table


def _memory(part: Part) -> list[tuple[str, str]]:
    """Fields of equal size, and their size."""
    names: dict[int, list[str]] = {}
    for name, value in part.fields.items():
        names.setdefault(allocated_bytes(value), []).append(name)
    return [(", ".join(group), size(count) + (" each" if group[1:] else "")) for count, group in names.items()]


def _kernels(result: Measurement, part: Part) -> list[tuple[str, ...]]:
    """Name, calls and times of each kernel."""
    costs = [(name, result.kernels[part.name, name]) for name in part.kernels]
    return [(name, str(cost.calls), *_times(result, cost)) for name, cost in costs]


def _times(result: Measurement, cost: Cost) -> tuple[str, str]:
    """Wall and CPU time of a step [ms]."""
    return f"{_per_step(result, cost.wall):.3f}", f"{_per_step(result, cost.cpu):.3f}"


def _per_step(result: Measurement, seconds: float) -> float:
    """Time of one step [ms]."""
    return 1e3 * seconds / max(1, result.steps)


def size(count: float) -> str:
    """Return a number of bytes as text, in the unit that gives a number below 1024."""
    for unit in ("B", "KiB", "MiB"):
        if count < 1024.0:
            return f"{count:.0f} {unit}" if unit == "B" else f"{count:.1f} {unit}"
        count /= 1024.0
    return f"{count:.1f} GiB"
