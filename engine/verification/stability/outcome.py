"""How a case ends: stable, stopped by a guard that names itself, or failed."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from engine.device import backend
from engine.errors import GuardFault
from engine.job.checkpoint import load_checkpoint, save_checkpoint
from engine.job.directory import JobDirectory, JobState, Status
from engine.job.session import Options, Session
from engine.simulation.conservation import as_row
from engine.simulation.guard import require_finite
from engine.verification.stability.case import ExtremeCase
from engine.verification.stability.measures import Measures, measures

STABLE, STOPPED, FAILED = "stable", "stopped", "failed"


@dataclass(frozen=True)
class CaseResult:
    """How a case ended.

    Attributes:
        group, name, precision, physical: of the case.
        verdict: `stable`, `stopped` or `failed`.
        reason: why it was stopped or failed.
        steps: time steps done.
        progress: fraction of the simulated time that was reached.
        cpu_time: of the run, compilation included [s].
        measures: extremes of its history.
    """

    group: str
    name: str
    precision: str
    physical: bool
    verdict: str
    reason: str
    steps: int = 0
    progress: float = 0.0
    cpu_time: float = 0.0
    measures: Measures = field(default_factory=Measures)

    def __str__(self) -> str:
        return f"{self.group:15} {self.name:27} {self.verdict:8} {self.steps:6d} steps  {self.reason}"

    @property
    def acceptable(self) -> bool:
        """Whether the case ended as it must: it did not fail, and if physical it ran to its end."""
        return self.verdict == STABLE or (self.verdict == STOPPED and not self.physical)


def failure(case: ExtremeCase, reason: str) -> CaseResult:
    """Return the outcome of a case that left nothing to measure."""
    return CaseResult(case.group, case.name, case.scene.numerics.precision, case.physical, FAILED, reason)


def run_case(case: ExtremeCase, directory: Path) -> CaseResult:
    """Run a case as a job of its own in this process and return how it ended; an exception is a failure.

    Args:
        case: what to run.
        directory: the job directory; exists and is empty.
    """
    try:
        return _run(case, directory)
    except Exception as error:  # an exception is an outcome of the matrix
        return failure(case, f"{type(error).__name__}: {error}")


def _run(case: ExtremeCase, directory: Path) -> CaseResult:
    backend.start("cpu", threads=1)
    run = Session(case.scene, JobDirectory(directory), Options(checkpoint_interval=1.0))
    _save_start(case, run)
    status = run.to_end()
    extremes = measures(run.guard, run.history.rows, backend.EPSILON)
    verdict, reason = _verdict(run, status, extremes)
    known = (case.group, case.name, case.scene.numerics.precision, case.physical)
    return CaseResult(*known, verdict, reason, status.step, status.progress, status.cpu_time, extremes)


def _save_start(case: ExtremeCase, run: Session) -> None:
    """Write the changed initial state as a checkpoint, from which the run then starts."""
    start = case.scene.start_time
    run.simulation.start(**case.changes(case.scene))
    # one that cannot be read back would silently be replaced by the scene's own start
    require_finite(run.simulation.particles.read(), start)
    times = {"history_due": start, "snapshot_due": np.inf, "wall_time": 0.0, "cpu_time": 0.0}
    save_checkpoint(run.job, run.simulation, times)


def _verdict(run: Session, status: Status, extremes: Measures) -> tuple[str, str]:
    if status.state == JobState.DONE:
        broken = extremes.broken()
        return (FAILED, f"{broken}, and no guard noticed") if broken else (STABLE, "")
    if status.fault and _checkpoint_is_good(run):
        return STOPPED, status.reason
    return FAILED, f"{status.reason}; no guard, or no checkpoint to go on from"


def _checkpoint_is_good(run: Session) -> bool:
    """Whether the checkpoint of a run that was stopped can be read and contains a state that the guard passes."""
    simulation = run.simulation
    if load_checkpoint(run.job, simulation) is None:
        return False
    try:
        row = as_row(simulation.totals(), time=simulation.time)
        run.guard.check(row, simulation.ledger.extremes(), simulation.particles)
    except GuardFault:
        return False
    return True
