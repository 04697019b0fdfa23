"""The machine and the code that figures belong to."""

import os
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path

from tests.benchmarks.child import ROOT

CPU_INFO = Path("/proc/cpuinfo")


def host() -> dict[str, str | int]:
    """Processor, cores, and the versions that generate code."""
    return {
        "cpu": _cpu(),
        "cores": os.cpu_count() or 1,
        "python": platform.python_version(),
        "taichi": version("taichi"),
    }


def commit() -> str:
    """Short commit of the code, marked when the engine was changed since."""
    try:
        changed = _git("status", "--porcelain", "--", "engine")
        return _git("rev-parse", "--short", "HEAD") + ("+" if changed else "")
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def _git(*arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True)
    return done.stdout.strip()


def _cpu() -> str:
    """Model name where Linux tells it, else the architecture."""
    lines = CPU_INFO.read_text(encoding="utf-8").splitlines() if CPU_INFO.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
