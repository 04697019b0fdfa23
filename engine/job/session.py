"""Session of a job: run it from its scene or its last checkpoint to its end."""

import logging
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from types import FrameType

import numpy as np
from numpy.typing import DTypeLike
from xarray import Dataset

from engine import PHYSICS_VERSION
from engine.device import backend
from engine.errors import MEMORY_IS_FULL, Fault, GuardFault, JobError, SceneError, is_out_of_memory
from engine.job.checkpoint import load_checkpoint, refuse_foreign, save_checkpoint
from engine.job.directory import HEARTBEAT_PERIOD, JobDirectory, JobState, Status
from engine.job.history import History
from engine.job.provenance import record_session
from engine.job.snapshot import FIELDS, snapshot
from engine.job.storage import Attributes, read_dataset, read_if_sound, write_dataset
from engine.scene.scene import Scene, scene_in
from engine.simulation.conservation import Row, as_row
from engine.simulation.guard import Guard
from engine.simulation.ledger import Extremes
from engine.simulation.simulation import Simulation
from engine.state.particles import Arrays

log = logging.getLogger("engine")


@dataclass(frozen=True)
class Options:
    """Options of a session, without influence on results.

    Attributes:
        arch: `cpu`, `cuda`, `vulkan` or `gpu`.
        threads: CPU threads.
        checkpoint_interval: computing time between checkpoints [s].
        report: called with the status every few seconds.
    """

    arch: str = "cpu"
    threads: int = 1
    checkpoint_interval: float = 30.0
    report: Callable[[Status], None] = lambda status: None


def run_job(directory: Path, options: Options) -> Status:
    """Run a job, from its last checkpoint if it has one.

    Args:
        directory: contains the scene.
        options: of this session.

    Returns:
        How the job then stands: done, failed or interrupted.

    Raises:
        SceneError: the directory contains no valid scene.
        JobError: another process runs it, or its files belong to another scene or physics version.
    """
    scene, job = scene_in(directory), JobDirectory(directory)
    with job.claim():
        status = job.status()
        if status.state == JobState.DONE and job.final.exists():
            refuse_foreign(read_dataset(job.final), scene, job.final)
            return status
        backend.start(options.arch, options.threads)
        try:
            return Session(scene, job, options).to_end()
        except (SceneError, JobError):
            raise
        except Exception as error:
            _leave_word(job, error)
            raise


def _leave_word(job: JobDirectory, error: Exception) -> None:
    """Write an unexpected error to log and status, unless the disk is full or fails."""
    log.exception("ended by an error")
    reason = MEMORY_IS_FULL if is_out_of_memory(error) else " ".join(f"{type(error).__name__}: {error}".split())
    with suppress(OSError, JobError):
        job.write_status(replace(job.status(), state=JobState.INTERRUPTED, reason=reason))


class Session:
    """One session of a job.

    Args:
        scene: what to simulate.
        job: its directory, claimed by this process.
        options: of this session.

    Attributes:
        simulation: the scene on the device.
        history: rows so far, those of earlier sessions included.
        history_due, snapshot_due: simulated time [s] of the next row and of the next snapshot.
        guard: bounds of the run.
    """

    def __init__(self, scene: Scene, job: JobDirectory, options: Options) -> None:
        self.scene, self.job, self.options = scene, job, options
        self.simulation = Simulation(scene)
        self.history = History()
        self.history_due = self.snapshot_due = scene.start_time
        if scene.output.snapshot_interval is None:
            self.snapshot_due = np.inf
        self.wall_before, self.begun = 0.0, time.monotonic()
        self.cpu_before, self.cpu_begun = 0.0, time.process_time()
        self.saved = self.reported = time.monotonic()
        self.rate = 0.0
        self.stopping = False

    def to_end(self) -> Status:
        """Advance until the end time, a fault, or a signal to stop, and return how the job then stands."""
        previous = {number: signal.signal(number, self._stop) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            self._begin()
            self._loop()
            return self._finish() if self.simulation.finished else self._interrupt()
        except GuardFault as stopped:
            return self._fail(stopped.fault)
        finally:
            for number, handler in previous.items():
                signal.signal(number, handler)

    def _stop(self, number: int, frame: FrameType | None) -> None:
        self.stopping = True

    def _begin(self) -> None:
        """Restore the last checkpoint, or start from the scene."""
        # an earlier session wrote its history before its checkpoint
        progress, history = load_checkpoint(self.job, self.simulation), read_if_sound(self.job.history)
        if progress is not None and history is None and self.simulation.step > 0:
            log.warning("history.nc is lost or damaged: started anew, to the same results")
            self.simulation, progress = Simulation(self.scene), None
        if progress is None:
            self.simulation.start()
            log.info("started at t = %.6g s", self.simulation.time)
        else:
            self._restore(progress, history)
            log.info("resumed at t = %.6g s, step %d", self.simulation.time, self.simulation.step)
        first = self.history.rows[0] if self.history.rows else self._row(self.simulation.ledger.extremes())
        self.guard = Guard(self.scene, first, self.simulation.first_dt)
        record_session(self.job, self.scene, backend.architecture(), self.options.threads)
        self._write_outputs()
        self._report(JobState.RUNNING)

    def _restore(self, progress: dict[str, float], history: Dataset | None) -> None:
        self.history_due, self.snapshot_due = progress["history_due"], progress["snapshot_due"]
        self.wall_before = progress["wall_time"]
        self.cpu_before = progress["cpu_time"]
        if history is not None:
            self.history = History.from_dataset(history.isel(time=history["step"] <= self.simulation.step))

    def _loop(self) -> None:
        steps, since = self.simulation.step, time.monotonic()
        while not (self.simulation.finished or self.stopping):
            self._advance()
            self._write_outputs()
            now = time.monotonic()
            if now - self.saved >= self.options.checkpoint_interval:
                self._save()
            if now - self.reported >= HEARTBEAT_PERIOD:
                self.rate = (self.simulation.step - steps) / (now - since)
                steps, since = self.simulation.step, now
                self._report(JobState.RUNNING)

    def _advance(self) -> None:
        simulation = self.simulation
        simulation.advance(min(self.history_due, self.snapshot_due))
        self.guard.check_time_step(simulation.next_dt, simulation.time, simulation.particles)

    def _write_outputs(self) -> None:
        """Write the row and the snapshot that are due; a row is always due at the end time."""
        output, simulation = self.scene.output, self.simulation
        if simulation.time >= self.history_due or (simulation.finished and self.history_due < np.inf):
            self._append_history()
            self.history_due = np.inf if simulation.finished else simulation.time + output.history_interval
        if simulation.time >= self.snapshot_due:
            self._write_snapshot()
            self.snapshot_due = simulation.time + (output.snapshot_interval or np.inf)

    def _append_history(self) -> None:
        self.history.append(self._checked())

    def _checked(self) -> Row:
        """Return the row of the history for the present time, passed by the guard."""
        simulation, extremes = self.simulation, self.simulation.ledger.extremes()
        row = self._row(extremes)
        self.guard.check(row, extremes, simulation.particles)
        return row

    def _row(self, extremes: Extremes) -> Row:
        """Row of the history for the present time."""
        simulation, events = self.simulation, self.simulation.events
        return as_row(
            simulation.totals(),
            time=simulation.time,
            step=simulation.step,
            dt=float(simulation.clock.dt[None]),
            gravity_change=events.gravity_change,
            gravity_force=events.gravity_force,
            gravity_torque=events.gravity_torque,
            largest_speed=extremes.speed,
            largest_compression=extremes.density,
            isolated=float(simulation.stencil.ballistic_count[None]),
        )

    def _attributes(self) -> Attributes:
        contact = float(self.simulation.clock.contact_time[None])
        return {
            **({"contact_time": contact} if np.isfinite(contact) else {}),
            "time": self.simulation.time,
            "step": self.simulation.step,
            "spacing": self.scene.spacing,
            "dx": self.scene.dx,
            "scene_hash": self.scene.hash(),
            "physics_version": PHYSICS_VERSION,
        }

    def _snapshot(self, state: Arrays, dtype: DTypeLike) -> Dataset:
        return snapshot(state, self.simulation.rho0(state), self._attributes(), dtype)

    def _write_snapshot(self) -> None:
        self.job.snapshots.mkdir(exist_ok=True)
        state = self.simulation.particles.read(*FIELDS)
        write_dataset(self.job.snapshot(self.simulation.step), self._snapshot(state, np.float32))

    def _write_history(self) -> None:
        attributes: Attributes = {"scene_hash": self.scene.hash(), "physics_version": PHYSICS_VERSION}
        write_dataset(self.job.history, self.history.dataset(attributes))

    def _save(self) -> None:
        """Write the history, then the checkpoint: a resumed run drops rows that are later than its checkpoint."""
        self._checked()
        self._write_history()
        due = {"history_due": self.history_due, "snapshot_due": self.snapshot_due, "wall_time": self._wall_time()}
        save_checkpoint(self.job, self.simulation, {**due, "cpu_time": self._cpu_time()})
        self.saved = time.monotonic()

    def _wall_time(self) -> float:
        return self.wall_before + time.monotonic() - self.begun

    def _cpu_time(self) -> float:
        return self.cpu_before + time.process_time() - self.cpu_begun

    def _report(self, state: JobState, reason: str = "", fault: Fault | None = None) -> Status:
        simulation, scene = self.simulation, self.scene
        left = (scene.end_time - simulation.time) / max(float(simulation.clock.dt[None]), 1e-300)
        status = Status(
            state=state,
            reason=reason,
            fault=fault,
            time=simulation.time,
            start_time=scene.start_time,
            end_time=scene.end_time,
            step=simulation.step,
            wall_time=self._wall_time(),
            cpu_time=self._cpu_time(),
            steps_per_second=self.rate,
            time_left=left / self.rate if self.rate > 0.0 and state == JobState.RUNNING else 0.0,
        )
        self.job.write_status(status)
        self.options.report(status)
        self.reported = time.monotonic()
        return status

    def _finish(self) -> Status:
        self._checked()
        self._write_history()
        state = self.simulation.particles.read(*FIELDS)
        write_dataset(self.job.final, self._snapshot(state, np.float64))
        log.info("done: %d steps in %.1f s", self.simulation.step, self._wall_time())
        return self._report(JobState.DONE)

    def _interrupt(self) -> Status:
        self._save()
        log.info("interrupted at t = %.6g s; run again to resume", self.simulation.time)
        return self._report(JobState.INTERRUPTED, "stopped by a signal; run again to resume")

    def _fail(self, fault: Fault) -> Status:
        """Report the fault that stopped the run; the last checkpoint stays as it is."""
        if self.history.rows:
            self._write_history()
        log.error("failed: %s", fault)
        return self._report(JobState.FAILED, str(fault), fault)
