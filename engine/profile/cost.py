"""Measure the wall and CPU time of the steps of a scene by running some in memory."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import ParamSpec, TypeVar

from engine.device import backend
from engine.job.checkpoint import load_checkpoint
from engine.job.directory import JobDirectory
from engine.profile.parts import parts_of
from engine.scene.scene import Scene, scene_at
from engine.simulation.simulation import Simulation

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


@dataclass
class Cost:
    """Time of a repeated task.

    Attributes:
        calls: number of runs.
        wall, cpu: wall time and CPU time of all threads [s].
    """

    calls: int = 0
    wall: float = 0.0
    cpu: float = 0.0

    @contextmanager
    def lap(self) -> Iterator[None]:
        """Add the work in the `with` block."""
        wall, cpu = time.perf_counter(), time.process_time()
        yield
        backend.wait()
        self.calls += 1
        self.wall += time.perf_counter() - wall
        self.cpu += time.process_time() - cpu


@dataclass
class Measurement:
    """Cost of some steps of a scene.

    Attributes:
        simulation: in the state after the steps.
        begun: simulated time [s] before the first step.
        steps: number of steps.
        whole: cost of all steps, kernels and host.
        kernels: cost of every kernel, by part and name.
    """

    simulation: Simulation
    begun: float
    steps: int = 0
    whole: Cost = field(default_factory=Cost)
    kernels: dict[tuple[str, str], Cost] = field(default_factory=dict)


def measure(source: Path, steps: int, arch: str, threads: int) -> Measurement:
    """Run some steps in memory, from the checkpoint of a job if it has one; no file is written.

    Args:
        source: a scene file or a job directory.
        steps: number of steps to measure, after one that compiles.
        arch: `cpu`, `cuda`, `vulkan` or `gpu`.
        threads: CPU threads.

    Raises:
        SceneError: the scene cannot be read.
        JobError: the checkpoint is of another scene or physics version.
        RunFault: a particle is outside the range in which the equations are valid.
    """
    scene = scene_at(source)
    backend.start(arch, threads)
    simulation = _begun(scene, source)
    simulation.advance(scene.end_time, steps=1)
    result = Measurement(simulation, simulation.time)
    _watch(result)
    first = simulation.step
    with result.whole.lap():
        while not simulation.finished and simulation.step - first < steps:
            simulation.advance(scene.end_time, steps=1)
    result.steps = simulation.step - first
    return result


def _begun(scene: Scene, source: Path) -> Simulation:
    """The scene at the checkpoint of its job, or at its start when there is none or nothing is left to run."""
    if source.is_dir():
        resumed = Simulation(scene)
        if load_checkpoint(JobDirectory(source), resumed) is not None and not resumed.finished:
            return resumed
    simulation = Simulation(scene)
    simulation.start()
    return simulation


def _watch(result: Measurement) -> None:
    """Replace every kernel of the simulation's parts by one that adds its time to the result."""
    for part in parts_of(result.simulation):
        for name in part.kernels:
            cost = result.kernels[part.name, name] = Cost()
            setattr(part.content, name, _timed(getattr(part.content, name), cost))
    transfer = result.simulation.transfer

    def step() -> None:
        for stage in (transfer, *transfer.stages):
            for kernel in stage.kernels:
                kernel()

    transfer.step = step


def _timed(kernel: Callable[Arguments, Result], cost: Cost) -> Callable[Arguments, Result]:
    def run(*arguments: Arguments.args, **named: Arguments.kwargs) -> Result:
        with cost.lap():
            return kernel(*arguments, **named)

    return run
