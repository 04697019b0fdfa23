"""Kernels are translated faster, and what Taichi says of a wrong one stays the same."""

import ast
import textwrap
from importlib.util import find_spec, module_from_spec
from types import SimpleNamespace
from typing import Any

import pytest
import taichi as ti
from hypothesis import given
from hypothesis import strategies as st

from engine.device.source_positions import LineWrapper, source_position
from engine.device.taichi_internals import ASTTransformerContext, kernel_impl

SOURCE = ["def halved(x):", "    y = x / 2.0", "    return y"]
FIRST, SECOND = ast.parse("\n".join(SOURCE)).body[0].body


class Inlined:
    """A function that is being translated, and how often its source was looked at."""

    indent = 0

    def __init__(self, file: str = "laws.py", lineno_offset: int = 10, name: str = "halved") -> None:
        self.file, self.lineno_offset = file, lineno_offset
        self.func = SimpleNamespace(func=SimpleNamespace(__name__=name))
        self.looks = 0

    @property
    def src(self) -> list[str]:
        self.looks += 1
        return SOURCE


def test_a_source_position_is_built_once_however_often_its_code_is_inlined() -> None:
    first, again = Inlined(lineno_offset=77), Inlined(lineno_offset=77)
    told = source_position(first, FIRST)
    assert "laws.py" in told and "line 79" in told and "halved" in told and "y = x / 2.0" in told
    assert first.looks > 0
    assert source_position(again, FIRST) == source_position(first, FIRST) == told
    assert again.looks == 0


@pytest.mark.parametrize("other", [{"file": "mpm.py"}, {"lineno_offset": 20}, {"name": "doubled"}])
def test_positions_of_other_code_are_told_apart(other: dict[str, object]) -> None:
    here = source_position(Inlined(), FIRST)
    assert source_position(Inlined(**other), FIRST) != here
    assert source_position(Inlined(), SECOND) != here


@given(text=st.text(alphabet=st.sampled_from("ab-. \t\n\xa0\u00e9"), max_size=30), width=st.integers(1, 30))
def test_lines_are_wrapped_as_taichi_does(text: str, width: int) -> None:
    assert LineWrapper(width=width).wrap(text) == textwrap.TextWrapper(width=width).wrap(text)


@ti.func
def halved(x):
    return x / 2.0


@pytest.mark.usefixtures("taichi")
def test_the_source_of_a_function_is_looked_up_once() -> None:
    lines, start = kernel_impl.getsourcelines(halved.func.func)
    assert kernel_impl.getsourcelines(halved.func.func)[0] is lines
    assert lines[1] == "def halved(x):\n" and start > 1


def error() -> str:
    """What Taichi says of a kernel that uses an unknown name beside an inlined function."""

    @ti.kernel
    def run():
        for i in range(2):
            print(halved(i) + nowhere)  # noqa: F821

    with pytest.raises(ti.TaichiCompilationError) as raised:
        run()
    return str(raised.value)


def taichis_own_method() -> Any:
    """`get_pos_info` as Taichi has it, from a second copy of its module: in the first one it is replaced."""
    spec = find_spec(ASTTransformerContext.__module__)
    assert spec and spec.loader
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.ASTTransformerContext.get_pos_info


@pytest.mark.usefixtures("taichi")
def test_errors_name_the_same_position_as_without_a_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = error(), error()
    assert ASTTransformerContext.get_pos_info is source_position
    monkeypatch.setattr(ASTTransformerContext, "get_pos_info", taichis_own_method())
    assert first == second == error()
    assert "nowhere" in first and "test_source_positions.py" in first
