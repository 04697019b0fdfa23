import pytest

from engine.device.options import VARIABLE, choose, chosen
from engine.errors import SceneError


def test_double_precision_is_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    assert chosen() == "f64"


def test_what_was_chosen_last_holds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "f64")
    choose("f32")
    assert chosen() == "f32"


def test_an_unknown_precision_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "f16")
    with pytest.raises(SceneError, match=r"'f16' is no precision; allowed: f64, f32"):
        chosen()
