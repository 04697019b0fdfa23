"""Runs of small campaigns with the fake engine."""

import errno
import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from dask.distributed import LocalCluster

from campaigns.directory import CampaignDirectory
from campaigns.expansion import expand
from campaigns.runner import CampaignRun
from campaigns.study import Study
from engine.device.options import Arch
from tests.helpers.jobs import BAD_DISK

Tree = Callable[[Path], dict[str, bytes]]


def starts(runs: Path, alias: str) -> list[str]:
    """The steps at which the engine was started on a job."""
    (log,) = runs.glob(f"small/jobs/{alias}-*/log.txt")
    return log.read_text().splitlines()


def job(runs: Path, alias: str) -> Path:
    (path,) = runs.glob(f"small/jobs/{alias}-*")
    return path


def test_runs_all_jobs(command, write_study, runs):
    result = command("run", write_study())
    assert result.code == 0
    assert "2 done" in result.out
    assert "make plots STUDY=" in result.out
    assert len(list(runs.glob("small/jobs/*/final.nc"))) == 2


def test_campaign_file_follows_the_contract(command, write_study, runs):
    command("run", write_study(angle="[5, 15]"))
    content = json.loads((runs / "small" / "campaign.json").read_text())
    assert set(content) == {"name", "physics_version", "study", "dims", "coords", "jobs"}
    assert content["dims"] == ["velocity", "angle"]
    assert content["coords"] == {"velocity": [100.0, 200.0], "angle": [5.0, 15.0]}
    first = content["jobs"][0]
    assert set(first) == {"id", "directory", "index", "collision"}
    assert first["directory"] == f"jobs/{first['id']}"
    assert first["index"] == {"velocity": 100.0, "angle": 5.0}
    assert first["collision"]["materials"]["basalt"]["rho0"] == 2700.0


def test_finished_jobs_are_never_touched(command, write_study, runs, tree: Tree):
    command("run", write_study())
    before = tree(runs)
    assert command("run", write_study()).code == 0
    assert tree(runs) == before


def test_extension_runs_only_new_jobs(command, write_study, runs, tree: Tree):
    command("run", write_study())
    before = tree(runs / "small" / "jobs")
    command("run", write_study(velocity="[300, 200.0, 100]", angle="[5, 30]"))
    after = tree(runs / "small" / "jobs")
    assert before.items() <= after.items()
    assert len(list(runs.glob("small/jobs/*/final.nc"))) == 6
    assert starts(runs, "v0100_a05") == ["from step 0"]


def test_new_axis_keeps_finished_jobs(command, write_study, runs):
    command("run", write_study())
    command("run", write_study(angle="[5]\nseed = [1, 2]"))
    assert starts(runs, "v0100_a05") == ["from step 0"]
    assert len(list(runs.glob("small/jobs/*"))) == 4


def test_a_setting_that_becomes_an_axis_keeps_finished_jobs(command, write_study, runs):
    command("run", write_study(collision="target.radius = 1e4"))
    assert command("run", write_study(angle="[5]\ntarget.radius = [1e4, 2e4]")).code == 0
    assert starts(runs, "v0100_a05") == ["from step 0"]
    assert len(list(runs.glob("small/jobs/*"))) == 4


ICE = "materials.ice = {cohesion = 1e6, intact_friction = 1.0, melt_energy = 7e5, friction = 0.6}"


@pytest.mark.parametrize("further", ["", "seed = [1, 2]"])
def test_a_new_material_keeps_finished_jobs(further, command, write_study, runs):
    command("run", write_study())
    axes = f"[5]\nprojectile.material = ['basalt', 'ice']\n{further}"
    assert command("run", write_study(collision=ICE, angle=axes)).code == 0
    assert starts(runs, "v0100_a05") == ["from step 0"]
    assert len(list(runs.glob("small/jobs/*"))) == (8 if further else 4)
    fewer = write_study(velocity="[200]", angle="[5, 10]")
    assert command("plan", fewer).code == 0, "constants of ice are no settings of a study without it"


@pytest.mark.parametrize(
    ("further", "jobs"),
    [
        ("target.spin_period = [8, 4]\ntarget.spin_obliquity = [0, 90]", 8),
        ("[[cases]]\nname = 'still'\n[[cases]]\nname = 'turning'\ntarget.spin_period = 8", 4),
    ],
    ids=["axes", "cases"],
)
def test_a_setting_that_is_varied_later_keeps_finished_jobs(command, write_study, runs, further, jobs):
    command("run", write_study(collision="target.spin_period = 8"))
    assert command("run", write_study(angle=f"[5]\n{further}")).code == 0
    assert starts(runs, "v0100_a05") == ["from step 0"]
    assert len(list(runs.glob("small/jobs/*"))) == jobs


def test_a_constant_of_a_material_in_use_is_not_changed_in_a_campaign(command, write_study):
    command("run", write_study(collision=f"{ICE}\nprojectile.material = 'ice'"))
    softer = ICE.replace("0.6", "0.5")
    result = command("run", write_study(collision=f"{softer}\nprojectile.material = 'ice'"))
    assert result.code == 2
    assert "materials.ice.friction 0.6 there and 0.5 in the study" in result.err


def test_error_bars_keep_finished_jobs(command, write_study, runs):
    command("run", write_study(velocity="[100]"))
    command("run", write_study(velocity="[100]", angle="[5]\n[error_bars]\nseeds = [1, 2]"))
    assert starts(runs, "v0100_a05") == ["from step 0"]
    assert len(list(runs.glob("small/jobs/*"))) == 4
    assert len(list(runs.glob("small/jobs/v0100_a05_resolution-coarse_seed*/final.nc"))) == 2


def test_jobs_that_left_the_study_stay(command, write_study, runs):
    command("run", write_study())
    command("run", write_study(velocity="[100]"))
    assert (job(runs, "v0200_a05") / "final.nc").is_file()
    assert len(json.loads((runs / "small" / "campaign.json").read_text())["jobs"]) == 1


def test_failed_job_is_tried_again_only_on_request(command, write_study, runs, monkeypatch):
    monkeypatch.setenv("FAKE_FAULT", "v0200")
    result = command("run", write_study())
    assert result.code == 1
    assert "1 done, 1 failed" in result.out
    assert "particle 7 left the range" in result.out
    monkeypatch.delenv("FAKE_FAULT")
    assert command("run", write_study()).code == 1
    assert len(starts(runs, "v0200_a05")) == 1
    assert command("run", write_study(), "--retry-failed").code == 0
    assert len(starts(runs, "v0200_a05")) == 2


def test_failed_job_is_tried_once_per_run(command, write_study, runs, monkeypatch):
    monkeypatch.setenv("FAKE_FAULT", "v0200")
    command("run", write_study(), "--retry-failed")
    assert len(starts(runs, "v0200_a05")) == 1


def test_crash_leaves_an_interrupted_job_that_resumes(command, write_study, runs, monkeypatch):
    monkeypatch.setenv("FAKE_CRASH", "v0200")
    result = command("run", write_study())
    assert result.code == 1
    assert "interrupted" in result.out
    assert "SIGKILL" in result.out
    (job(runs, "v0200_a05") / "checkpoint.nc").write_text("6")
    monkeypatch.delenv("FAKE_CRASH")
    assert command("resume", write_study()).code == 0
    assert starts(runs, "v0200_a05") == ["from step 0", "from step 6"]


def test_what_the_last_session_says_is_shown_in_place_of_what_an_earlier_one_said(
    command, write_study, runs, monkeypatch
):
    monkeypatch.setenv("FAKE_CRASH", "v0200")
    command("run", write_study())
    monkeypatch.delenv("FAKE_CRASH")
    status = job(runs, "v0200_a05") / "status.json"
    earlier = {"state": "interrupted", "reason": "stopped by a signal; run again to resume"}
    status.write_text(json.dumps({**json.loads(status.read_text()), **earlier}))
    monkeypatch.setenv("FAKE_BAD_DISK", "v0200")
    told = command("resume", write_study()).out
    assert "checkpoint.nc: Input/output error: cannot be read now" in told and "stopped by a signal" not in told


def test_refused_input_shows_the_engine_s_last_line(command, write_study, monkeypatch):
    monkeypatch.setenv("FAKE_REFUSAL", "v0200")
    result = command("run", write_study())
    assert result.code == 1
    assert "'velocity': not today" in result.out


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("status.json", "{"),
        ("status.json", '{"state": "gone fishing"}'),
        ("status.json", '{"state": "running", "time": "soon", "pid": -1}'),
        ("status.json", '{"state": "running", "pid": "many", "host": 3}'),
        ("status.json", "[]"),
        ("status.json", '{"state": "done"}'),
        ("scene.json", "{}"),
    ],
)
def test_corrupt_job_stops_no_other(command, write_study, runs, file, content, monkeypatch):
    monkeypatch.setenv("FAKE_CRASH", "v0")
    command("run", write_study())
    monkeypatch.delenv("FAKE_CRASH")
    (job(runs, "v0200_a05") / file).write_text(content)
    result = command("run", write_study())
    assert result.code == 1
    assert "1 done, 1 corrupt" in result.out
    assert file in result.out
    shown = command("status", write_study())
    assert shown.code == 0
    assert "corrupt" in shown.out


@pytest.mark.parametrize("file", ["status.json", "scene.json"])
def test_a_job_that_cannot_be_read_now_is_kept_and_tried_again(command, write_study, runs, file, monkeypatch):
    monkeypatch.setenv("FAKE_CRASH", "v0")
    command("run", write_study())
    monkeypatch.delenv("FAKE_CRASH")
    path, well = job(runs, "v0200_a05") / file, job(runs, "v0200_a05") / "well"
    path.rename(well)
    path.symlink_to(BAD_DISK)
    result = command("run", write_study())
    assert result.code == 1
    assert "1 done, 1 unreadable" in result.out
    assert f"{file}: Input/output error: cannot be read now; it is kept" in result.out
    assert "away" not in result.out and "delete" not in result.out
    well.replace(path)
    assert command("resume", write_study()).code == 0


def test_a_job_directory_without_rights_stops_no_other(command, write_study, runs, monkeypatch):
    is_file = Path.is_file

    def refused(path: Path) -> bool:
        if path.parent.name.startswith("v0200"):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return is_file(path)

    command("plan", write_study())
    monkeypatch.setattr(Path, "is_file", refused)
    result = command("run", write_study())
    assert result.code == 1
    assert "1 done, 1 unreadable" in result.out and "Permission denied: cannot be read now" in result.out
    monkeypatch.undo()
    assert command("resume", write_study()).code == 0


def test_resume_needs_a_campaign(command, write_study, runs):
    result = command("resume", write_study())
    assert result.code == 2
    assert "make campaign" in result.err
    assert not runs.exists()


def test_plan_writes_nothing_and_gives_reasons(command, write_study, runs, monkeypatch, tree: Tree):
    assert "2 of 2 jobs would run" in command("plan", write_study()).out
    assert not runs.exists()
    monkeypatch.setenv("FAKE_FAULT", "v0200")
    command("run", write_study())
    before = tree(runs)
    planned = command("plan", write_study(velocity="[100, 200, 300]"))
    assert [line.split()[0] for line in planned.out.splitlines()[:3]] == ["skip", "skip", "run"]
    assert "--retry-failed" in planned.out
    assert "2 of 3 jobs would run" in command("plan", write_study(velocity="[100, 200, 300]"), "--retry-failed").out
    assert tree(runs) == before


def test_where_prints_the_campaign_directory(command, write_study, runs):
    assert command("where", write_study()).out.strip() == str(runs / "small")


def test_full_disk_is_one_line(command, write_study, runs, monkeypatch):
    def full(*arguments: object) -> None:
        raise OSError(28, "No space left on device", str(runs / "small" / "campaign.json"))

    monkeypatch.setattr("campaigns.directory.write_json", full)
    result = command("run", write_study())
    assert result.code == 1
    assert len(result.err.splitlines()) == 1
    assert "No space left on device" in result.err


def test_results_name_that_is_a_file(command, write_study, runs):
    runs.mkdir()
    (runs / "small").write_text("notes")
    result = command("run", write_study())
    assert result.code == 2
    assert "is a file" in result.err


def test_unreachable_scheduler(command, write_study, runs, monkeypatch):
    monkeypatch.setattr("campaigns.cluster.CONNECTION_TIMEOUT", 0.2)
    result = command("run", write_study(), "--scheduler", "tcp://127.0.0.1:1")
    assert result.code == 2
    assert "cannot be reached" in result.err
    assert not runs.exists()


def test_running_scheduler_is_used(command, write_study):
    options = {"n_workers": 1, "threads_per_worker": 2, "processes": False, "dashboard_address": None}
    with LocalCluster(protocol="tcp", **options) as cluster:
        assert command("run", write_study(), "--scheduler", cluster.scheduler_address).code == 0


def test_slurm_without_jobqueue(command, write_study, monkeypatch, runs):
    monkeypatch.setitem(sys.modules, "dask_jobqueue", None)
    result = command("run", write_study(), "--slurm")
    assert result.code == 2
    assert "pip install" in result.err
    assert not runs.exists()


class LateCluster:
    """A client whose workers run the given numbers of engines, one after the other, each time they are signalled."""

    def __init__(self, alive: list[int]) -> None:
        self.alive = alive
        self.submitted: list[Path] = []
        self.signals: list[tuple[list[Path], int]] = []

    def submit(self, function: Any, path: Path, *arguments: Any, **options: Any) -> Any:
        self.submitted.append(path)
        return SimpleNamespace(done=lambda: False)

    def cancel(self, futures: list[Any]) -> None:
        """Do nothing: a worker that has begun a job goes on."""

    def run(self, function: Any, paths: list[Path], number: int) -> dict[str, int]:
        self.signals.append((paths, number))
        return {"worker": self.alive.pop(0) if self.alive else 0}


def test_a_stopped_campaign_ends_also_an_engine_that_a_worker_begins_late(runs):
    """Two engines end at the first signal; a third one begins when none has been left."""
    campaign = expand(Study(name="small", axes={"velocity": [100, 200, 300], "angle": [5]}), "test")
    client = LateCluster([2, 0, 1, 0])

    def ctrl_c(jobs: Any) -> None:
        raise KeyboardInterrupt

    run = CampaignRun(
        CampaignDirectory(runs / "small"), campaign, client, threads=1, arch=Arch.CPU, gpu_share=0.0, retry_failed=False
    )
    with pytest.raises(KeyboardInterrupt):
        run.watch(ctrl_c)
    assert not client.alive, "watched until no engine was left, the late one included"
    assert len(client.submitted) == 3
    assert client.signals[2] == (client.submitted, signal.SIGTERM)
    assert signal.SIGKILL not in [number for _, number in client.signals], "none was killed that could end in order"
