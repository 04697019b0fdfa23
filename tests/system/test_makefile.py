"""The Makefile explains itself and never deletes results."""

import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]


def make(*arguments: str) -> str:
    return subprocess.run(["make", *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout


def test_help_is_the_default_and_names_all_targets():
    listed = make("--silent")
    targets = [line.split(":")[0] for line in (ROOT / "Makefile").read_text().splitlines() if ": " in line]
    phony = (ROOT / "Makefile").read_text().partition(".PHONY: ")[2].splitlines()[0].split()
    assert set(phony) <= set(targets)
    assert all(f"  {target} " in listed for target in phony)
    assert "quick" in listed


def test_clean_leaves_results():
    assert "runs" not in make("--dry-run", "clean", "RUNS=runs")


def test_campaign_passes_its_variables():
    lines = make("--dry-run", "campaign", "STUDY=a b.toml", "RUNS=elsewhere", "WORKERS=3", "OPTIONS=--retry-failed")
    assert "campaigns run 'a b.toml' --runs 'elsewhere' --workers 3" in lines
    assert "--retry-failed" in lines


def test_missing_python_is_one_clear_line(tmp_path):
    done = subprocess.run(
        ["make", "test", "PYTHON=", f"VENV={tmp_path / 'venv'}"], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode != 0
    assert "no Python 3.11, 3.12 or 3.13" in done.stderr
