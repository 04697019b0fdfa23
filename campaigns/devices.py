"""The GPUs that jobs of one dask worker may use, and which of them the next job gets."""

import os
import subprocess
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock

from engine.device.options import CUDA_DEVICES as CUDA
from engine.device.options import VULKAN_DEVICE as VULKAN
from engine.device.options import Arch

RESOURCE = "GPU"
"""Dask's resource of which a worker has as many as it has GPUs; a job takes its share of one."""

HIDDEN = ("", "-1", "NoDevFiles")
"""Texts of the variable that hide all devices."""

_JOBS: Counter[tuple[str, str]] = Counter()
_LOCK = Lock()

LIST_GPUS = ("nvidia-smi", "--query-gpu=index", "--format=csv,noheader")


def visible(arch: Arch) -> tuple[str, list[str]]:
    """The variable that names a job's device, and the devices that this process sees; "" is the driver's choice.

    Args:
        arch: any but `cpu`.
    """
    cuda = _given(CUDA)
    if cuda is None:
        cuda = _listed()
    if arch == Arch.CUDA or (arch == Arch.GPU and cuda):
        return CUDA, cuda or [""]
    return VULKAN, _given(VULKAN) or [""]


@contextmanager
def one_device(arch: Arch) -> Iterator[dict[str, str]]:
    """The environment of a job: on a GPU, the device with the fewest jobs of this process, until the block ends."""
    if arch == Arch.CPU:
        yield dict(os.environ)
        return
    variable, devices = visible(arch)
    with _LOCK:
        device = min(devices, key=lambda name: _JOBS[variable, name])
        _JOBS[variable, device] += 1
    try:
        yield {**os.environ, variable: device} if device else dict(os.environ)
    finally:
        with _LOCK:
            _JOBS[variable, device] -= 1


def _given(variable: str) -> list[str] | None:
    """Devices that the environment names, none where it hides all; `None` where it says nothing."""
    text = os.environ.get(variable)
    if text is None:
        return None
    return [] if text.strip() in HIDDEN else [device.strip() for device in text.split(",") if device.strip()]


@cache
def _listed() -> list[str]:
    """Devices of NVIDIA's driver; none if it is not there or does not answer."""
    try:
        listed = subprocess.run(LIST_GPUS, capture_output=True, text=True, timeout=30, check=True)
    except (OSError, subprocess.SubprocessError):
        return []
    return listed.stdout.split()
