"""Provenance of results: command, code, packages and device of every session of a job."""

import hashlib
import json
import os
import platform
import socket
import subprocess
import sys
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from engine import PHYSICS_VERSION
from engine.device.backend import Real
from engine.device.options import CUDA_DEVICES, VULKAN_DEVICE
from engine.job.directory import JobDirectory
from engine.job.storage import NO_FILE, read_or_unavailable, write_json
from engine.scene.scene import Scene

PACKAGES = ("asteroid-collisions", "taichi", "numpy", "scipy", "xarray", "netCDF4", "pydantic")


def record_session(job: JobDirectory, scene: Scene, arch: str, threads: int) -> None:
    """Add this session to provenance.json.

    Args:
        job: the job directory.
        scene: what is run.
        arch: `cpu`, `cuda` or `vulkan`.
        threads: CPU threads.

    Raises:
        UnavailableError: the file of earlier sessions cannot be read now.
        OSError: the file cannot be written.
    """
    sessions = [*_earlier_sessions(job), _session(arch, threads)]
    content = {
        "physics_version": PHYSICS_VERSION,
        "scene_hash": scene.hash(),
        "seed": scene.seed,
        "sessions": sessions,
    }
    write_json(job.provenance, content)


def _earlier_sessions(job: JobDirectory) -> list[object]:
    try:
        with read_or_unavailable(job.provenance):
            return list(json.loads(job.provenance.read_text(encoding="utf-8"))["sessions"])
    except (*NO_FILE, ValueError, KeyError, TypeError):
        return []


def _session(arch: str, threads: int) -> dict[str, object]:
    return {
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": sys.argv,
        "host": socket.gethostname(),
        "platform": platform.platform(),
        "python": platform.python_version(),
        "packages": {name: _version(name) for name in PACKAGES},
        "arch": arch,
        "devices": {name: os.environ[name] for name in (CUDA_DEVICES, VULKAN_DEVICE) if name in os.environ},
        "threads": threads,
        "precision": str(Real),
        "git": _git_state(),
    }


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


def _git_state() -> dict[str, object]:
    """Commit of the code, whether the code differs from it, and a hash of the difference."""
    try:
        commit = _git("rev-parse", "HEAD").decode().strip()
        difference = _git("diff", "HEAD")
    except (OSError, subprocess.SubprocessError):
        return {"commit": "unknown"}
    return {"commit": commit, "dirty": bool(difference), "difference": hashlib.sha256(difference).hexdigest()}


def _git(*arguments: str) -> bytes:
    command = ["git", "-C", str(Path(__file__).parent), *arguments]
    return subprocess.run(command, check=True, capture_output=True, timeout=10).stdout
