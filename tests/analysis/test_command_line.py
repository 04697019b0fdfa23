"""The exit codes of `python -m analysis`."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from analysis.cli import app
from engine.scene.collision import Collision
from tests.helpers.fake_jobs import write_campaign, write_job


@pytest.mark.parametrize("command", ["plots", "collect"])
@pytest.mark.parametrize(("state", "code"), [("done", 1), ("failed", 0)])
def test_a_job_that_says_done_and_is_damaged_is_told(tmp_path: Path, command: str, state: str, code: int) -> None:
    collision = Collision(velocity=100.0, angle=5.0)
    write_campaign(tmp_path, {"velocity": [100.0], "angle": [5.0]}, [({"velocity": 100.0, "angle": 5.0}, collision)])
    write_job(tmp_path / "jobs" / "0", collision, None, state, "too fast" if state == "failed" else "")
    told = CliRunner().invoke(app, [command, str(tmp_path)])
    assert told.exit_code == code
    assert ("0: corrupt: " in told.output) == (state == "done")
