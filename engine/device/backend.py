"""Configure and start Taichi; the types of all fields, in the precision of this process."""

import os
import time
from contextlib import redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import taichi as ti

from engine.device.options import VARIABLE, chosen, usable_cores
from engine.device.source_positions import cache_source_positions
from engine.device.taichi_internals import current_cfg, is_arch_supported, to_numpy_type
from engine.errors import SceneError

PRECISION = chosen()
"""Precision of this process, `f64` or `f32`."""

Real = {"f64": ti.f64, "f32": ti.f32}[PRECISION]
"""Precision of every field and literal but time and position."""

EPSILON = float(np.finfo(to_numpy_type(Real)).eps)
"""Spacing of the numbers of this precision at 1."""

place3 = ti.types.vector(3, ti.f64)
"""Position, in double precision: in single precision the displacement of a step would be lost to round-off."""

vec3 = ti.types.vector(3, Real)
vec4 = ti.types.vector(4, Real)
vec6 = ti.types.vector(6, Real)
mat3 = ti.types.matrix(3, 3, Real)

TASK = 512
"""Iterations of a CPU loop that Taichi gives to one thread at a time.

A loop over few, long items therefore runs over TASK times their number and works in every TASK-th iteration.
"""

STALE_LOCK_AGE = 60.0
"""Age [s] from which a lock on the kernel cache is removed: with one of a killed process Taichi never caches again."""


def start(arch: str = "cpu", threads: int | None = None) -> None:
    """Start Taichi in this process; all fields that exist become invalid.

    Args:
        arch: `cpu`, `cuda`, `vulkan`, or `gpu` for the one of both that there is.
        threads: CPU threads; all cores that this process may use if `None`.

    Raises:
        SceneError: the device is not available.
    """
    cache_source_positions()
    with redirect_stdout(StringIO()):  # ti.init prints a banner that no option silences
        ti.init(
            arch=_available(arch),
            default_fp=Real,
            default_ip=ti.i32,
            fast_math=False,
            cpu_max_num_threads=threads or usable_cores(),
            offline_cache=True,
            offline_cache_file_path=str(_cache_directory()),
            log_level=ti.ERROR,
        )


def _available(arch: str) -> Any:
    """Taichi's name of the device.

    Raises:
        SceneError: it is not here.
    """
    choices = {"cpu": (ti.cpu,), "cuda": (ti.cuda,), "vulkan": (ti.vulkan,), "gpu": (ti.cuda, ti.vulkan)}[arch]
    found = [choice for choice in choices if choice == ti.cpu or is_arch_supported(choice)]
    if not found:
        wanted = {
            "cuda": "no CUDA device",
            "vulkan": "no Vulkan driver",
            "gpu": "neither a CUDA device nor a Vulkan driver",
        }
        raise SceneError(f"--arch {arch}: Taichi finds {wanted[arch]} here; use --arch cpu")
    return found[0]


def wait() -> None:
    """Wait until the device has finished all its work."""
    ti.sync()


def require_precision(precision: str) -> None:
    """Check that a scene asks for the precision of this process.

    Args:
        precision: `f64` or `f32`.

    Raises:
        SceneError: the device modules were imported for another precision.
    """
    if precision != PRECISION:
        raise SceneError(
            f"'numerics.precision': the scene asks for {precision}, but this process computes in {PRECISION}; "
            f"run it with python -m engine run, or set {VARIABLE}={precision} before the engine is imported"
        )


def architecture() -> str:
    """Return where kernels run: `cpu`, `cuda` or `vulkan`."""
    return "cpu" if not on_gpu() else str(current_cfg().arch).removeprefix("Arch.")


def on_gpu() -> bool:
    """Return whether kernels run on a GPU."""
    return bool(current_cfg().arch != ti.cpu)


def has_elementary_functions() -> bool:
    """Return whether the device has exp, log, pow, sin and their inverses in the precision of this process."""
    return PRECISION == "f32" or current_cfg().arch != ti.vulkan


def _cache_directory() -> Path:
    root = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    cache = root / "asteroid-collisions" / "kernels"
    for lock in cache.glob("**/*.lock"):
        with suppress(FileNotFoundError):  # its owner may remove it at any time
            if time.time() - lock.stat().st_mtime > STALE_LOCK_AGE:
                lock.unlink()
    return cache
