"""Jobs are spread over the GPUs that a process sees, and never share one unless asked to."""

import time
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from campaigns import devices
from campaigns.cli import _gpus
from campaigns.cluster import Resources, connect
from campaigns.devices import CUDA, RESOURCE, VULKAN, one_device, visible
from engine.device.options import Arch
from engine.errors import SceneError


@pytest.fixture(autouse=True)
def no_driver(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(devices, "LIST_GPUS", ("no-such-command",))
    for variable in (CUDA, VULKAN):
        monkeypatch.delenv(variable, raising=False)
    yield


def driver(monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    """A driver that lists this many GPUs."""
    monkeypatch.setattr(devices, "LIST_GPUS", ("seq", "0", str(count - 1)))


@pytest.mark.parametrize(
    ("arch", "given", "expected"),
    [
        (Arch.CUDA, {}, (CUDA, ["0"])),
        (Arch.CUDA, {CUDA: "3, 5"}, (CUDA, ["3", "5"])),
        (Arch.CUDA, {CUDA: "GPU-8932f937,GPU-ab"}, (CUDA, ["GPU-8932f937", "GPU-ab"])),
        (Arch.VULKAN, {CUDA: "3,5"}, (VULKAN, ["0"])),
        (Arch.VULKAN, {VULKAN: "1"}, (VULKAN, ["1"])),
        (Arch.GPU, {}, (VULKAN, ["0"])),
        (Arch.GPU, {CUDA: "1"}, (CUDA, ["1"])),
    ],
)
def test_devices_are_those_that_the_process_may_see(
    arch: Arch, given: dict[str, str], expected: tuple[str, list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    for variable, value in given.items():
        monkeypatch.setenv(variable, value)
    assert visible(arch) == expected


def test_a_process_that_may_see_all_sees_those_of_the_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    driver(monkeypatch, 4)
    assert visible(Arch.GPU) == visible(Arch.CUDA) == (CUDA, ["0", "1", "2", "3"])
    monkeypatch.setenv(CUDA, "2")
    assert visible(Arch.GPU) == (CUDA, ["2"])


def test_the_next_job_gets_the_device_with_the_fewest(monkeypatch: pytest.MonkeyPatch) -> None:
    driver(monkeypatch, 3)
    with ExitStack() as jobs:
        seen = [jobs.enter_context(one_device(Arch.CUDA))[CUDA] for _ in range(4)]
        assert seen == ["0", "1", "2", "0"]
        with one_device(Arch.CUDA) as environment:
            assert environment[CUDA] == "1"
        with one_device(Arch.CUDA) as environment:
            assert environment[CUDA] == "1", "the job before has ended"
    with one_device(Arch.CPU) as environment:
        assert CUDA not in environment


def times_of_a_job() -> tuple[float, float]:
    """Begin and end of a job that takes a moment."""
    begin = time.monotonic()
    time.sleep(0.2)
    return begin, time.monotonic()


@pytest.mark.parametrize(("share", "most"), [(1.0, 2), (0.5, 4)])
def test_no_more_jobs_run_than_the_gpus_bear(share: float, most: int) -> None:
    with connect(Resources(workers=8, threads=1, gpus=2)) as client:
        jobs = [client.submit(times_of_a_job, pure=False, resources={RESOURCE: share}) for _ in range(8)]
        times = client.gather(jobs)
    assert max(sum(begin <= t < end for begin, end in times) for t, _ in times) == most


def test_jobs_on_a_gpu_are_refused_on_the_cpu(monkeypatch: pytest.MonkeyPatch) -> None:
    driver(monkeypatch, 3)
    assert _gpus(Arch.CPU, None) == (0, 1)
    assert _gpus(Arch.CUDA, None) == (3, 1) and _gpus(Arch.GPU, 2) == (3, 2)
    with pytest.raises(SceneError, match="--jobs-per-gpu: jobs run on the CPU; add --arch gpu"):
        _gpus(Arch.CPU, 2)
