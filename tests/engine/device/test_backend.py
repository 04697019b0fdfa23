import os
import time
from pathlib import Path

import numpy as np
import pytest
import taichi as ti

from engine.device import backend
from engine.device.taichi_internals import is_arch_supported
from engine.errors import SceneError


@pytest.mark.parametrize(("age", "stays"), [(2.0 * backend.STALE_LOCK_AGE, False), (0.0, True)])
def test_only_an_old_lock_on_the_kernel_cache_is_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, age: float, stays: bool
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    lock = tmp_path / "asteroid-collisions" / "kernels" / "llvm" / "metadata.lock"
    lock.parent.mkdir(parents=True)
    lock.touch()
    os.utime(lock, (time.time() - age, time.time() - age))
    backend.start(threads=1)
    assert lock.exists() == stays


def test_starting_again_resets_the_device() -> None:
    backend.start(threads=1)
    field = ti.field(backend.Real, 3)
    field.fill(7.0)
    backend.start(threads=1)
    again = ti.field(backend.Real, 3)
    assert not again.to_numpy().any()
    assert not backend.on_gpu()


@pytest.mark.skipif(is_arch_supported(ti.cuda), reason="a GPU is there")
def test_a_missing_gpu_is_named() -> None:
    with pytest.raises(SceneError, match="--arch cuda: Taichi finds no CUDA device here"):
        backend.start(arch="cuda")


def test_numbers_have_the_precision_of_the_process() -> None:
    assert ("f64", float(np.finfo(np.float64).eps)) == (backend.PRECISION, backend.EPSILON)


def test_a_process_of_another_precision_refuses_the_scene() -> None:
    backend.require_precision("f64")
    with pytest.raises(SceneError, match=r"'numerics\.precision': the scene asks for f32"):
        backend.require_precision("f32")
