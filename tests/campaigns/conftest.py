import signal
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

import campaigns.cli
import campaigns.runner
import campaigns.worker
from tests.helpers import fake_engine

STUDY = """
name = "{name}"
[collision]
particles = 10
{collision}
[axes]
velocity = {velocity}
angle = {angle}
"""


@dataclass(frozen=True)
class Result:
    """What a command printed and how it ended."""

    code: int
    out: str
    err: str


Command = Callable[..., Result]
WriteStudy = Callable[..., Path]


@pytest.fixture
def write_study(tmp_path: Path) -> WriteStudy:
    """Write a study file of a small grid, or of the text given."""

    def write(
        text: str = STUDY, name: str = "small", collision: str = "", velocity: str = "[100, 200]", angle: str = "[5]"
    ) -> Path:
        path = tmp_path / "study.toml"
        values = {"name": name, "collision": collision, "velocity": velocity, "angle": angle}
        path.write_text(text.format(**values) if text is STUDY else text)
        return path

    return write


@pytest.fixture
def runs(tmp_path: Path) -> Path:
    """The results directory of the tests."""
    return tmp_path / "runs"


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], runs: Path) -> Iterator[Command]:
    """Run `python -m campaigns` in this process with the fake engine."""
    monkeypatch.setattr(campaigns.worker, "ENGINE", (sys.executable, str(Path(fake_engine.__file__))))
    monkeypatch.setattr(campaigns.runner, "PERIOD", 0.05)
    handler = signal.getsignal(signal.SIGTERM)

    def call(*arguments: object) -> Result:
        monkeypatch.setattr(sys, "argv", ["campaigns", *map(str, arguments), "--runs", str(runs)])
        with pytest.raises(SystemExit) as ending:
            campaigns.cli.main()
        printed = capsys.readouterr()
        code = ending.value.code
        return Result(code if isinstance(code, int) else 0, printed.out, printed.err)

    yield call
    signal.signal(signal.SIGTERM, handler)


@pytest.fixture
def tree() -> Callable[[Path], dict[str, bytes]]:
    """The content of all files below a directory."""

    def read(path: Path) -> dict[str, bytes]:
        return {str(file.relative_to(path)): file.read_bytes() for file in sorted(path.rglob("*")) if file.is_file()}

    return read
