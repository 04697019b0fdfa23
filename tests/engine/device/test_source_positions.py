"""Kernels are translated faster, and what Taichi says of a wrong one stays the same."""

import pytest
import taichi as ti

from engine.device import source_positions

pytestmark = pytest.mark.usefixtures("taichi")


@ti.func
def halved(x):
    return x / 2.0


def translate(times: int) -> float:
    """What `halved`, inlined some times, makes of 1."""
    result = ti.field(ti.f64, ())

    @ti.kernel
    def run():
        x = 1.0
        for _ in ti.static(range(times)):
            x = halved(x)
        result[None] = x

    run()
    return float(result[None])


def error() -> str:
    @ti.kernel
    def run():
        for i in range(2):
            print(halved(i) + nowhere)  # noqa: F821

    with pytest.raises(ti.TaichiCompilationError) as raised:
        run()
    return str(raised.value)


def test_a_source_position_is_built_once_however_often_its_code_is_inlined(monkeypatch: pytest.MonkeyPatch) -> None:
    built = []
    monkeypatch.setattr(source_positions, "_cache", {})
    build = source_positions._build_text
    monkeypatch.setattr(
        source_positions, "_build_text", lambda context, node: built.append(node) or build(context, node)
    )
    assert translate(1) == 0.5
    once = len(built)
    assert translate(8) == 2.0**-8
    assert once > 10 and len(built) == once


def test_errors_name_the_same_position_as_without_a_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = error(), error()
    monkeypatch.setattr(source_positions.ASTTransformerContext, "get_pos_info", source_positions._build_text)
    assert first == second == error()
    assert "nowhere" in first and "test_source_positions.py" in first
