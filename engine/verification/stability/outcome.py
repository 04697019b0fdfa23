"""How a case ends: stable, stopped by a guard that names itself, or failed."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from engine import backend
from engine.bounds import energy_growth, momentum_drift
from engine.checkpoint import load_checkpoint, save_checkpoint
from engine.guard import require_finite
from engine.history import Row
from engine.jobdir import JobDirectory, Status
from engine.run import Options, Run
from engine.verification.stability.case import Case

STABLE, STOPPED, FAILED = "stable", "stopped", "failed"

LARGEST_GROWTH = 0.02
"""Growth of the total energy up to which a run is stable, in the measure of engine.bounds.energy_growth."""


@dataclass(frozen=True)
class Outcome:
    """What a case came to.

    Attributes:
        group, name, physical: of the case.
        verdict: `stable`, `stopped` or `failed`.
        reason: why it was stopped or failed.
        steps: time steps done.
        progress: share of the simulated time that was reached.
        energy_growth: largest growth of the total energy on the way, as a share of all energies [-].
        dissipation: loss of total energy from start to end, as the same share [-].
        momentum_drift: largest change of momentum over mass times the scene's speeds [-].
        speed: highest speed, as a share of the guard's bound [-].
        compression: highest rho/rho0 [-].
        compression_bound: the guard's bound of it [-].
    """

    group: str
    name: str
    physical: bool
    verdict: str
    reason: str
    steps: int = 0
    progress: float = 0.0
    energy_growth: float = np.nan
    dissipation: float = np.nan
    momentum_drift: float = np.nan
    speed: float = np.nan
    compression: float = np.nan
    compression_bound: float = np.nan

    @property
    def acceptable(self) -> bool:
        """Whether this may be: nothing fails, and what is physical runs to its end."""
        return self.verdict == STABLE or (self.verdict == STOPPED and not self.physical)


def run_case(case: Case, directory: Path) -> Outcome:
    """Run a case as a job of its own; whatever goes wrong is an outcome too.

    Args:
        case: what to run.
        directory: the job directory, made here.
    """
    try:
        return _run(case, directory)
    except Exception as error:  # any exception but a guard's is what the matrix looks for
        return Outcome(case.group, case.name, case.physical, FAILED, f"{type(error).__name__}: {error}")


def _run(case: Case, directory: Path) -> Outcome:
    backend.start("cpu", threads=1)
    directory.mkdir(parents=True)
    job = JobDirectory(directory)
    run = Run(case.scene, job, Options(checkpoint_interval=1.0))
    _save_start(case, run)
    status = run.to_end()
    verdict, reason = _verdict(run, status)
    rows = run.history.rows
    return Outcome(
        case.group, case.name, case.physical, verdict, reason, status.step, status.progress, **_measures(run, rows)
    )


def _save_start(case: Case, run: Run) -> None:
    """Write the changed initial state as a checkpoint, from which the run then begins."""
    start = case.scene.start_time
    run.simulation.start(**case.changes(case.scene))
    times = {"history_due": start, "snapshot_due": np.inf, "wall_time": 0.0, "cpu_time": 0.0}
    save_checkpoint(run.job, run.simulation, times)


def _verdict(run: Run, status: Status) -> tuple[str, str]:
    if status.state == "done":
        growth = max(energy_growth(run.scene, row, run.history.rows[0]) for row in run.history.rows)
        known = run.scene.physics.energy
        grown = known and growth > LARGEST_GROWTH
        return (FAILED, f"total energy grew by {growth:.2%} and no guard noticed") if grown else (STABLE, "")
    if status.fault and _checkpoint_is_good(run):
        return STOPPED, status.reason
    return FAILED, f"{status.reason}; no guard, or no checkpoint to go on from"


def _checkpoint_is_good(run: Run) -> bool:
    """Whether the checkpoint of a run that was stopped holds a state that the guard passes."""
    if load_checkpoint(run.job, run.simulation) is None:
        return False
    require_finite(run.simulation.particles.read(), run.simulation.time)
    return True


def _measures(run: Run, rows: list[Row]) -> dict[str, float]:
    """What the history says; without a row nothing is known."""
    if not rows:
        return {}
    growth = [energy_growth(run.scene, row, rows[0]) for row in rows]
    known = run.scene.physics.energy
    return {
        "energy_growth": max(growth) if known else np.nan,
        "dissipation": -growth[-1] if known else np.nan,
        "momentum_drift": max(momentum_drift(row, rows[0]) for row in rows) / run.guard.momentum,
        "speed": max(float(row["largest_speed"]) for row in rows) / run.guard.speed,
        "compression": max(float(row["largest_compression"]) for row in rows),
        "compression_bound": run.guard.compression,
    }


UNITS = {"steps": "time steps done", "progress": "share of the simulated time that was reached"}


def dataset(outcomes: list[Outcome]) -> xr.Dataset:
    """All outcomes, dimension case."""
    names = list(Outcome.__dataclass_fields__)
    columns = {name: ("case", np.array([getattr(outcome, name) for outcome in outcomes])) for name in names}
    columns["physical"] = ("case", columns["physical"][1].astype(np.int8))
    result = xr.Dataset(columns, attrs={"Conventions": "CF-1.11", "title": "Stability of stiff and extreme cases"})
    return result.set_coords(["group", "name"])
