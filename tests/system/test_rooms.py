"""Imports between rooms (folders) go one way, and texts cite sections that exist."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

FLOORS = (
    ("engine",),  # engine/*.py: constants, errors, quantities
    ("engine.device",),
    ("engine.scene", "engine.state"),
    ("engine.laws", "engine.gravity", "engine.mpm"),
    ("engine.simulation",),
    ("engine.job",),
    ("engine.profile", "engine.verification", "campaigns"),
    ("analysis.remnant", "engine.front"),
    ("analysis.results",),
    ("analysis.report", "analysis.accuracy"),
    ("analysis",),
)
"""Rooms from the ground up; a room imports those below it, and those of its own floor as long as no circle closes."""

FRONT = ("engine/__init__.py", "engine/__main__.py", "engine/cli.py", "engine/api.py")
"""Files of engine/ through which users enter; they open its rooms, `__init__` only when a name is asked for."""

CITATION = re.compile(r"physics\.md[`)]*,? sections? ([0-9]+(?:(?:,| and|-| to)? ?[0-9]+)*)")


def sources() -> Iterator[Path]:
    for package in ("engine", "campaigns", "analysis"):
        yield from (ROOT / package).rglob("*.py")


def room_of(module: str) -> str:
    """The longest known room that a module lies in."""
    rooms = [room for floor in FLOORS for room in floor]
    return max((room for room in rooms if f"{module}.".startswith(f"{room}.")), key=len)


def floor_of(room: str) -> int:
    return next(number for number, floor in enumerate(FLOORS) if room in floor)


def room_of_file(path: Path) -> str:
    name = path.relative_to(ROOT).as_posix()
    return "engine.front" if name in FRONT else room_of(name.removesuffix(".py").replace("/", "."))


def imported(tree: ast.AST) -> Iterator[str]:
    """Modules of this project that a file imports, anywhere in it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)


def arrows() -> dict[tuple[str, str], str]:
    """From which room to which something is imported, with a file that does."""
    found = {}
    for path in sources():
        own = room_of_file(path)
        for module in imported(ast.parse(path.read_text())):
            if module.partition(".")[0] in ("engine", "campaigns", "analysis") and room_of(module) != own:
                found[own, room_of(module)] = str(path.relative_to(ROOT))
    return found


def test_every_folder_is_a_room_or_in_one() -> None:
    folders = {".".join(path.parent.relative_to(ROOT).parts) for path in sources()}
    inside_engine = {folder for folder in folders if folder.startswith("engine.")}
    assert all(room_of(folder) != "engine" for folder in inside_engine)


def test_no_import_goes_upward() -> None:
    upward = {pair: file for pair, file in arrows().items() if floor_of(pair[0]) < floor_of(pair[1])}
    assert not upward


def test_no_imports_go_in_a_circle() -> None:
    left = set(arrows())
    while left:
        sources_only = {a for a, _ in left} - {b for _, b in left}
        assert sources_only, f"circle among {sorted(left)}"
        left = {(a, b) for a, b in left if a not in sources_only}


def cited(text: str) -> set[int]:
    """Numbers of the sections of physics.md that a text cites."""
    return {int(number) for numbers in CITATION.findall(text) for number in re.findall("[0-9]+", numbers)}


@pytest.mark.parametrize("path", sorted(p for p in sources() if cited(p.read_text())), ids=lambda p: p.name)
def test_cited_sections_exist(path: Path) -> None:
    headings = re.findall(r"^## ([0-9]+)\.", (ROOT / "engine" / "physics.md").read_text(), re.MULTILINE)
    assert cited(path.read_text()) <= set(map(int, headings))


def test_a_citation_is_found_in_each_of_its_forms() -> None:
    text = "(engine/physics.md, section 2) engine/physics.md, sections 7 and 8; (engine/physics.md, sections 2-5)"
    assert cited(text) == {2, 7, 8, 5}
