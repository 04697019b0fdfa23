import os
import subprocess
import sys

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


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system has no affinity masks")
def test_threads_are_those_of_the_cores_that_a_process_may_use() -> None:
    """As in a slice of a batch system: one core of a machine that has more."""
    core = min(os.sched_getaffinity(0))
    code = f"import os; os.sched_setaffinity(0, {{{core}}}); from engine.cli import CORES; print(CORES)"
    told = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert told.stdout.split() == ["1"]
