"""The GPUs that jobs of one dask worker may use, and which of them the next job gets."""

import os
import subprocess
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

from engine.device.options import Arch

RESOURCE = "GPU"
"""Dask's resource of which a worker has as many as it has GPUs; a job takes its share of one."""

CUDA, VULKAN = "CUDA_VISIBLE_DEVICES", "TI_VISIBLE_DEVICE"
"""Environment variables by which a job sees one device."""

_JOBS: Counter[str] = Counter()
_LOCK = Lock()

LIST_GPUS = ("nvidia-smi", "--query-gpu=index", "--format=csv,noheader")


def visible(arch: Arch) -> tuple[str, list[str]]:
    """The variable that names a job's device, and the devices that this process sees; one if it cannot tell.

    Args:
        arch: any but `cpu`.
    """
    cuda = _given(CUDA) or _listed()
    if arch == Arch.CUDA or (arch == Arch.GPU and cuda):
        return CUDA, cuda or ["0"]
    return VULKAN, _given(VULKAN) or ["0"]


@contextmanager
def one_device(arch: Arch) -> Iterator[dict[str, str]]:
    """The environment of a job: on a GPU, the device with the fewest jobs of this process, until the block ends."""
    if arch == Arch.CPU:
        yield dict(os.environ)
        return
    variable, devices = visible(arch)
    with _LOCK:
        device = min(devices, key=lambda name: _JOBS[name])
        _JOBS[device] += 1
    try:
        yield {**os.environ, variable: device}
    finally:
        with _LOCK:
            _JOBS[device] -= 1


def _given(variable: str) -> list[str]:
    return [device.strip() for device in os.environ.get(variable, "").split(",") if device.strip()]


def _listed() -> list[str]:
    """Devices of NVIDIA's driver; none if it is not there or does not answer."""
    try:
        listed = subprocess.run(LIST_GPUS, capture_output=True, text=True, timeout=30, check=True)
    except (OSError, subprocess.SubprocessError):
        return []
    return listed.stdout.split()
