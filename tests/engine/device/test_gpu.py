"""The code path of GPUs, on a Vulkan device in double and single precision; each run is a process of its own."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import taichi as ti

from engine.device.options import VARIABLE
from engine.device.taichi_internals import is_arch_supported
from tests.helpers.jobs import assert_same_results, run_engine, start_and_stop, write_job

TESTS = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(
    not is_arch_supported(ti.vulkan),
    reason="no Vulkan device, so the code path of GPUs is not tested; Debian's mesa-vulkan-drivers has one in software",
)


def run_tests(precision: str, *tests: str, **environment: str) -> None:
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *(str(TESTS / test) for test in tests)]
    given = {**os.environ, VARIABLE: precision, **environment}
    result = subprocess.run(command, env=given, capture_output=True, text=True, check=False)
    assert result.returncode == 0 and " passed" in result.stdout, result.stdout


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_a_gpu_computes_what_the_cpu_does(precision: str) -> None:
    run_tests(precision, "engine/device/gpu_cases.py")


def test_tensors_laws_and_gravity_hold_on_a_gpu() -> None:
    laws = ("tillotson", "friction", "shear")
    tests = [f"engine/laws/test_{name}.py" for name in laws]
    run_tests("f64", "engine/device/test_tensors.py", "engine/gravity/test_barnes_hut.py", *tests, TEST_ARCH="vulkan")


def test_a_killed_job_resumes_to_the_same_bits_on_a_gpu(tmp_path: Path) -> None:
    whole, killed = (write_job(tmp_path / name, particles=30, end_time=150.0) for name in ("whole", "killed"))
    assert start_and_stop(killed, signal.SIGKILL, "--arch", "vulkan") == -signal.SIGKILL
    for job in (whole, killed):
        result = run_engine(job, "--arch", "vulkan")
        assert result.returncode == 0, result.stderr
    assert "resumed" in (killed / "log.txt").read_text()
    assert_same_results(whole, killed)


def test_the_parts_of_a_scene_are_priced_on_a_gpu(tmp_path: Path) -> None:
    job = write_job(tmp_path / "job", particles=30)
    command = [sys.executable, "-m", "engine", "explain", str(job), "--arch", "gpu", "--steps", "3"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0 and "particles_to_grid" in result.stdout, result.stdout + result.stderr
