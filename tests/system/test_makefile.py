"""The Makefile explains itself, does what the README says, and never deletes results."""

import re
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest
from typer.main import get_command

import analysis.cli
import campaigns.cli
import engine.cli

ROOT = Path(__file__).parents[2]

NAMED = sorted(set(re.findall(r"(?:^    |`)make ([a-z-]+)", (ROOT / "README.md").read_text(), re.MULTILINE)))
"""Targets that the README tells its reader to make."""

APPLICATIONS = {"analysis": analysis.cli.app, "campaigns": campaigns.cli.app, "engine": engine.cli.application}


def make(*arguments: str) -> str:
    return subprocess.run(["make", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout


@pytest.fixture(scope="module")
def explained() -> dict[str, str]:
    """What `make` without a target, which is `make help`, says of each target."""
    assert make("--silent") == make("--silent", "help")
    return dict(re.findall(r"^  ([a-z-]+) +(.+)$", make("--silent"), re.MULTILINE))


def test_the_readme_names_targets() -> None:
    assert {"campaign", "resume", "status", "test"} <= set(NAMED)


@pytest.mark.parametrize("target", NAMED)
def test_a_target_of_the_readme_is_explained_and_runs_commands_that_exist(target: str, explained) -> None:
    assert len(explained[target].split()) > 2
    commands = re.findall(r"bin/python -m (\S+)(?: ([a-z]+))?", make("--dry-run", target))
    assert commands or target == "help"
    for module, command in commands:
        if module in APPLICATIONS:
            assert command in get_command(APPLICATIONS[module]).commands
        else:
            assert find_spec(module)


def test_every_target_is_explained(explained) -> None:
    targets = re.findall(r"^([a-z-]+):.* ## ", (ROOT / "Makefile").read_text(), re.MULTILINE)
    (phony,) = re.findall(r"^\.PHONY: (.+)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert sorted(phony.split()) == sorted(targets) == sorted(explained)


def test_help_names_the_shipped_studies() -> None:
    for study in (ROOT / "campaigns" / "studies").glob("*.toml"):
        assert study.stem in make("--silent", "help")


def test_clean_leaves_results() -> None:
    assert "runs" not in make("--dry-run", "clean", "RUNS=runs")


def test_campaign_passes_its_variables() -> None:
    lines = make("--dry-run", "campaign", "STUDY=a b.toml", "RUNS=elsewhere", "WORKERS=3", "OPTIONS=--retry-failed")
    assert "campaigns run 'a b.toml' --runs 'elsewhere' --workers 3" in lines
    assert "--retry-failed" in lines


def test_missing_python_is_one_clear_line(tmp_path: Path) -> None:
    done = subprocess.run(
        ["make", "test", "PYTHON=", f"VENV={tmp_path / 'venv'}"], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode != 0
    assert "no Python 3.11, 3.12 or 3.13" in done.stderr
