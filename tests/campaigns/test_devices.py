"""Jobs are spread over the GPUs that a process sees, and never share one unless asked to."""

import time
from collections.abc import Iterator
from contextlib import ExitStack

import dask
import pytest
from dask.distributed import LocalCluster

from campaigns import cluster, devices
from campaigns.cli import _gpus
from campaigns.cluster import Resources, connect
from campaigns.devices import RESOURCE, one_device, visible
from engine.device.options import CUDA_DEVICES as CUDA
from engine.device.options import VULKAN_DEVICE as VULKAN
from engine.device.options import Arch
from engine.errors import SceneError


@pytest.fixture(autouse=True)
def no_driver(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(devices, "LIST_GPUS", ("no-such-command",))
    devices._listed.cache_clear()
    for variable in (CUDA, VULKAN):
        monkeypatch.delenv(variable, raising=False)
    yield
    devices._listed.cache_clear()


def driver(monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    """A driver that lists this many GPUs."""
    monkeypatch.setattr(devices, "LIST_GPUS", ("seq", "0", str(count - 1)))


@pytest.mark.parametrize(
    ("arch", "given", "expected"),
    [
        (Arch.CUDA, {}, (CUDA, [""])),
        (Arch.CUDA, {CUDA: "3, 5"}, (CUDA, ["3", "5"])),
        (Arch.CUDA, {CUDA: "GPU-8932f937,GPU-ab"}, (CUDA, ["GPU-8932f937", "GPU-ab"])),
        (Arch.VULKAN, {CUDA: "3,5"}, (VULKAN, [""])),
        (Arch.VULKAN, {VULKAN: "1"}, (VULKAN, ["1"])),
        (Arch.GPU, {}, (VULKAN, [""])),
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
    for hidden in ("", "-1"):
        monkeypatch.setenv(CUDA, hidden)
        assert visible(Arch.GPU) == (VULKAN, [""]), "all of them are hidden"


def test_the_next_job_gets_the_device_with_the_fewest(monkeypatch: pytest.MonkeyPatch) -> None:
    driver(monkeypatch, 3)
    with ExitStack() as jobs:
        seen = [jobs.enter_context(one_device(Arch.CUDA))[CUDA] for _ in range(4)]
        assert seen == ["0", "1", "2", "0"]
        with one_device(Arch.CUDA) as environment:
            assert environment[CUDA] == "1"
        with one_device(Arch.CUDA) as environment:
            assert environment[CUDA] == "1", "the job before has ended"
    for arch in (Arch.CPU, Arch.VULKAN):
        with one_device(arch) as environment:
            assert not {CUDA, VULKAN} & environment.keys(), "the driver chooses"


def times_of_a_job() -> tuple[float, float]:
    """Begin and end of a job that takes a moment."""
    begin = time.monotonic()
    time.sleep(0.2)
    return begin, time.monotonic()


@pytest.mark.parametrize(("jobs_per_gpu", "most"), [(1, 2), (2, 4), (9, 18)])
def test_as_many_jobs_run_as_the_gpus_bear(jobs_per_gpu: int, most: int) -> None:
    resources = Resources(workers=20, threads=1, gpus=2, jobs_per_gpu=jobs_per_gpu)
    needed = {RESOURCE: resources.gpu_share}
    with connect(resources) as client:
        times = client.gather([client.submit(times_of_a_job, pure=False, resources=needed) for _ in range(2 * most)])
    assert max(sum(begin <= t < end for begin, end in times) for t, _ in times) == most


def test_a_scheduler_whose_workers_have_no_gpu_is_refused() -> None:
    with LocalCluster(n_workers=1, processes=False, dashboard_address="127.0.0.1:0") as local:
        address = local.scheduler_address
        on_gpu = Resources(workers=1, threads=1, gpus=1, scheduler=address)
        with pytest.raises(SceneError, match="none of its workers has a GPU; start them with"), connect(on_gpu):
            pass
        with connect(Resources(workers=1, threads=1, scheduler=address)):
            pass


def test_slurm_workers_have_a_gpu_only_if_asked_and_keep_what_the_settings_give() -> None:
    with dask.config.set({"jobqueue.slurm.worker-extra-args": ["--nanny"]}):
        assert cluster._with_gpu(Resources(workers=1, threads=1)) == {}
        given = cluster._with_gpu(Resources(workers=1, threads=1, gpus=1))
    assert given == {"worker_extra_args": ["--nanny", "--resources", "GPU=1"]}


def test_jobs_on_a_gpu_are_refused_on_the_cpu(monkeypatch: pytest.MonkeyPatch) -> None:
    driver(monkeypatch, 3)
    assert _gpus(Arch.CPU, None) == (0, 1)
    assert _gpus(Arch.CUDA, None) == (3, 1) and _gpus(Arch.GPU, 2) == (3, 2)
    with pytest.raises(SceneError, match="--jobs-per-gpu: jobs run on the CPU; add --arch gpu"):
        _gpus(Arch.CPU, 2)
