"""Kernels are translated faster, and what Taichi says of a wrong one stays the same."""

import pytest
import taichi as ti

from engine.device import source_positions as translation

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


def test_a_place_is_worded_once_however_often_its_code_is_inlined(monkeypatch: pytest.MonkeyPatch) -> None:
    worded = []
    monkeypatch.setattr(translation, "_worded", {})
    word = translation._word
    monkeypatch.setattr(translation, "_word", lambda context, node: worded.append(node) or word(context, node))
    assert translate(1) == 0.5
    once = len(worded)
    assert translate(8) == 2.0**-8
    assert once > 10 and len(worded) == once


def test_errors_name_the_same_place_as_without(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = error(), error()
    monkeypatch.setattr(translation.ASTTransformerContext, "get_pos_info", translation._word)
    assert first == second == error()
    assert "nowhere" in first and "test_translation.py" in first
