"""Provenance: one entry for each session of a job."""

import json
import sys
from pathlib import Path

import pytest

from engine import PHYSICS_VERSION
from engine.job.directory import JobDirectory
from engine.job.provenance import PACKAGES, record_session
from tests.helpers.scenes import body, scene

SCENE = scene(body(), seed=7)


def recorded(directory: Path) -> dict[str, object]:
    return dict(json.loads((directory / "provenance.json").read_text(encoding="utf-8")))


def test_a_session_names_scene_command_packages_and_device(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["engine", "run", "here"])
    monkeypatch.setenv("CUDA_VISIBLE_DEVICES", "3")
    monkeypatch.delenv("TI_VISIBLE_DEVICE", raising=False)
    record_session(JobDirectory(tmp_path), SCENE, "cpu", 3)
    content = recorded(tmp_path)
    assert (content["physics_version"], content["scene_hash"], content["seed"]) == (PHYSICS_VERSION, SCENE.hash(), 7)
    (session,) = content["sessions"]
    assert (session["command"], session["arch"], session["threads"]) == (["engine", "run", "here"], "cpu", 3)
    assert session["devices"] == {"CUDA_VISIBLE_DEVICES": "3"}
    assert session["precision"] == "f64" and set(session["packages"]) == set(PACKAGES)
    assert session["packages"]["taichi"].startswith("1.7") and session["git"]["commit"]


def test_sessions_add_up(tmp_path: Path) -> None:
    for threads in (1, 2):
        record_session(JobDirectory(tmp_path), SCENE, "cpu", threads)
    assert [session["threads"] for session in recorded(tmp_path)["sessions"]] == [1, 2]


@pytest.mark.parametrize("content", ["", "{}", "[1]", '{"sessions": 3}'])
def test_a_damaged_file_begins_anew(tmp_path: Path, content: str) -> None:
    (tmp_path / "provenance.json").write_text(content)
    record_session(JobDirectory(tmp_path), SCENE, "cpu", 1)
    assert len(recorded(tmp_path)["sessions"]) == 1


def test_without_a_repository_the_commit_is_unknown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    record_session(JobDirectory(tmp_path), SCENE, "cpu", 1)
    (session,) = recorded(tmp_path)["sessions"]
    assert session["git"] == {"commit": "unknown"}
