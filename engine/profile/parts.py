"""Fields and kernels of the parts of a simulation, found from their attributes."""

import inspect
from collections.abc import Iterator
from dataclasses import dataclass
from math import prod

import numpy as np
from pydantic import BaseModel

from engine.device.taichi_internals import Field, StructField, is_kernel, to_numpy_type
from engine.simulation.simulation import Simulation


@dataclass(frozen=True)
class Part:
    """One part of a simulation.

    Attributes:
        name: attribute of the object that owns it; in a tuple its own, or that of its class.
        content: the part itself.
        fields: its fields by name, less those that belong to a part inside it or beside it.
        kernels: names of its kernels.
    """

    name: str
    content: object
    fields: dict[str, Field]
    kernels: tuple[str, ...]

    @property
    def is_empty(self) -> bool:
        """Whether it has neither fields nor kernels of its own: physics left out, or a combination of other parts."""
        return not (self.fields or self.kernels)


def parts_of(simulation: Simulation) -> list[Part]:
    """Return all parts of a simulation, outer ones first; a field shared by several belongs to the innermost."""
    parts: list[Part] = []
    claimed: set[int] = set()
    for name, content in reversed(list(_walk(simulation))):
        fields = {key: field for key, field in own_fields(content).items() if id(field) not in claimed}
        claimed.update(map(id, fields.values()))
        parts.append(Part(name, content, fields, _kernels(content)))
    return parts[::-1]


def name_in_tuple(content: object) -> str:
    """Return the name of a part in a tuple, as of a stage of a step."""
    return str(getattr(content, "name", type(content).__name__.lower()))


def own_fields(content: object) -> dict[str, Field]:
    """Return the fields among the attributes of an object, by name."""
    return {name: value for name, value in vars(content).items() if isinstance(value, Field)}


def allocated_bytes(field: Field) -> int:
    """Memory of a field [bytes]."""
    return int(prod(field.shape)) * entry_bytes(field)


def entry_bytes(field: Field) -> int:
    """Memory of one entry of a field [bytes]."""
    if isinstance(field, StructField):
        return sum(entry_bytes(field.get_member_field(key)) for key in field.keys)
    components = getattr(field, "n", 1) * getattr(field, "m", 1)
    return int(components * np.dtype(to_numpy_type(field.dtype)).itemsize)


def _walk(simulation: Simulation) -> Iterator[tuple[str, object]]:
    """Names and parts, breadth first, each part once."""
    seen: set[int] = {id(simulation)}
    queue: list[tuple[str, object]] = [("simulation", simulation)]
    while queue:
        name, content = queue.pop(0)
        yield name, content
        for key, value in _attributes(content):
            if _is_part(value) and id(value) not in seen:
                seen.add(id(value))
                queue.append((key, value))


def _attributes(content: object) -> Iterator[tuple[str, object]]:
    """Attributes of an object, and in place of a tuple its members."""
    for key, value in vars(content).items():
        if isinstance(value, tuple):
            yield from ((name_in_tuple(member), member) for member in value)
        else:
            yield key, value


def _is_part(value: object) -> bool:
    return type(value).__module__.partition(".")[0] == "engine" and not isinstance(value, BaseModel)


def _kernels(content: object) -> tuple[str, ...]:
    kind = type(content)
    return tuple(name for name in dir(kind) if is_kernel(inspect.getattr_static(kind, name)))
