"""One job in, its outcome as a flat set of numbers out."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from analysis.remnant.conservation import drifts, heats, read_history
from analysis.remnant.contact import contact_of
from analysis.remnant.ellipsoid import THIN, Ellipsoid, bulk_density, ellipsoid_of, kurtosis
from analysis.remnant.filled import filled_volume
from analysis.remnant.flow import linear_flow
from analysis.remnant.fragments import OTHER_LENGTHS, Clumps, as_points, bound_to_largest, clumps_of
from analysis.remnant.hull import hull_of
from analysis.remnant.lobes import lobes_of
from analysis.remnant.particles import Integers, Particles, read_particles, snapshots
from analysis.remnant.settling import recent_changes
from analysis.remnant.spin import spin_period
from analysis.remnant.variables import DAMAGED, DRIFTS, UndescribedError, described
from engine.errors import JobError, RunFault, SceneError, UnavailableError, in_words
from engine.job.directory import JobDirectory, JobState
from engine.job.storage import NO_FILE
from engine.scene.scene import Scene, is_hash_of, scene_in

Numbers = dict[str, float]

ANEW = "move the directory of this job away and run the study again to compute it anew"
"""What to do with a job whose files are damaged."""

LATER = "keep it, and try again later"
"""What to do with a job of which a file cannot be read now."""

FOREIGN = "keep it: it may be sound, and the version that computed it, named in provenance.json, can measure it"
"""What to do with a job whose scene or physics this version does not know."""

UNREAD = "keep it, and look whether the disk and this program are well"
"""What to do with a job that could not be measured for another reason."""


@dataclass(frozen=True)
class Outcome:
    """What became of one job.

    Attributes:
        job: its directory.
        state: how the job stands.
        reason: one line on why there are no numbers, empty otherwise.
        numbers: the variables of `analysis.remnant.variables.OUTCOMES` of a job that is done, none of any other.
        in_remnant: whether each particle at the end is in the largest remnant, shape [particle_count]; empty likewise.
        foreign: whether another version of this project computed it, as far as one can tell.
    """

    job: JobDirectory
    state: JobState
    reason: str = ""
    numbers: Numbers = field(default_factory=dict)
    in_remnant: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    foreign: bool = False

    def read_remnant(self) -> Particles:
        """Read the particles of the largest remnant of a job that is done.

        Raises:
            JobError, RunFault: as `read_particles`.
        """
        return read_particles(self.job.final).select(self.in_remnant)


Outcomes = dict[str, Outcome]
"""The outcome of each job of a campaign, by job id."""


def outcome(job: JobDirectory, physics_version: int) -> Outcome:
    """The outcome of a job; one that cannot be read is `unreadable` or `corrupt` and raises nothing.

    Args:
        job: the job directory.
        physics_version: a job computed with any other is not measured.

    Raises:
        UndescribedError: as `measure`.
    """
    try:
        status = job.status()
        if status.state != JobState.DONE:
            return Outcome(job, status.state, _line(status.reason))
        particles = read_particles(job.final)
        if particles.physics_version != physics_version:
            version = particles.physics_version
            return _foreign(job, f"computed with physics version {version}, not {physics_version}")
        labels = clumps_of(particles)
        return Outcome(job, JobState.DONE, numbers=measure(job, particles, labels), in_remnant=labels == 0)
    except RunFault as fault:
        return Outcome(job, JobState.FAILED, _line(fault))
    except SceneError as error:
        if isinstance(error.__cause__, OSError) and not isinstance(error.__cause__, NO_FILE):
            return Outcome(job, JobState.UNREADABLE, f"{_line(error)}; {LATER}")
        return _foreign(job, _line(error))
    except UnavailableError as error:
        return Outcome(job, JobState.UNREADABLE, _line(error))
    except JobError as error:
        return Outcome(job, JobState.CORRUPT, f"{_line(error)}; {ANEW}")
    except (UndescribedError, MemoryError):
        raise
    except OSError as error:
        return Outcome(job, JobState.UNREADABLE, f"{in_words(error, job.path)}; {LATER}")
    except Exception as error:  # whatever is wrong with one job must not hide the others
        return Outcome(job, JobState.CORRUPT, f"{type(error).__name__}: {_line(error)}; {UNREAD}")


def _foreign(job: JobDirectory, reason: str) -> Outcome:
    """The outcome of a job that another version of this project may measure."""
    return Outcome(job, JobState.CORRUPT, f"{reason}; {FOREIGN}", foreign=True)


def latest(job: JobDirectory) -> Particles:
    """The particles at the end, or in the last snapshot of a job that is not there yet.

    Raises:
        JobError: the job has neither, or it cannot be read.
        RunFault: a value is not finite.
    """
    if job.final.is_file():
        return read_particles(job.final)
    taken = snapshots(job)
    if not taken:
        raise JobError(f"{job.path}: holds neither final.nc nor a snapshot; run the job first")
    return read_particles(taken[-1][1])


def measure(job: JobDirectory, particles: Particles, labels: Integers) -> Numbers:
    """Measure every variable of `analysis.remnant.variables.OUTCOMES`.

    Args:
        job: the job directory, for its scene, history and snapshots.
        particles: its final state, or an earlier one.
        labels: clump of each particle, from `clumps_of`, shape [particle_count].

    Raises:
        JobError, SceneError: a file of the job cannot be read, or is of another scene.
        UndescribedError: a variable is measured and not described, or described and not measured.
    """
    scene, status = scene_in(job.path), job.status()
    if not is_hash_of(particles.scene_hash, scene, job.path):
        raise SceneError(f"{job.path}: contains particles that are not of the scene in this directory")
    remnant = particles.select(labels == 0)
    clumps = as_points(labels, particles.mass, particles.position, particles.velocity)
    bound = bound_to_largest(clumps)
    history = read_history(job.history)
    last = drifts(history, scene).isel(time=-1)
    return described(
        _masses(clumps, bound, scene.bodies[0].mass)
        | _other_lengths(particles, scene.bodies[0].mass)
        | _contact(scene, particles.contact_time)
        | _ellipsoid(remnant)
        | _hull(remnant)
        | _interior(remnant)
        | _motion(remnant, particles.select(bound[labels]))
        | _settling(remnant, job)
        | {drift: float(last[name]) for drift, name in DRIFTS.items()}
        | heats(history)
        | {"steps": float(status.step), "wall_time": status.wall_time, "cpu_time": status.cpu_time}
    )


def _masses(clumps: Clumps, bound: NDArray[np.bool_], target: float) -> Numbers:
    return {
        "mass_ratio": float(clumps.mass[0] / target),
        "second_mass_ratio": float(clumps.mass[1:2].sum() / target),
        "bound_mass_ratio": float(clumps.mass[bound].sum() / target),
        "clumps": float(len(clumps.mass)),
    }


def _other_lengths(particles: Particles, target: float) -> Numbers:
    """Mass of the largest clump at other linking lengths, over the target's."""
    labels = {name: clumps_of(particles, length) for name, length in OTHER_LENGTHS.items()}
    return {name: float(particles.mass[label == 0].sum() / target) for name, label in labels.items()}


def _contact(scene: Scene, time: float) -> Numbers:
    met = contact_of(scene, time)
    return {"contact_time": time, "contact_offset": met.offset, "contact_angle": met.angle}


def _ellipsoid(remnant: Particles) -> Numbers:
    shape = ellipsoid_of(remnant.position, remnant.mass)
    extended = ellipsoid_of(remnant.position, remnant.mass, remnant.spacing)
    mass, filled = float(remnant.mass.sum()), filled_volume(remnant.position, remnant.spacing)
    return {
        "b_over_a": shape.b_over_a,
        "c_over_a": shape.c_over_a,
        "c_over_a_extended": extended.c_over_a,
        **{f"axis_{name}": float(axis) for name, axis in zip("abc", shape.axes, strict=True)},
        "c_unresolved": float(shape.axes[2] < THIN * remnant.spacing),
        "kurtosis_a": kurtosis(remnant.position, remnant.mass, shape.directions[0]),
        "bulk_density": bulk_density(mass, shape.volume),
        "particle_density": bulk_density(mass, float((remnant.mass / remnant.rho).sum())),
        "filled_volume": filled,
        "filled_density": bulk_density(mass, filled),
        **_lobes(remnant, shape),
        "spin_period": spin_period(remnant.position, remnant.velocity, remnant.mass),
    }


def _lobes(remnant: Particles, shape: Ellipsoid) -> Numbers:
    lobes = lobes_of(remnant.position, remnant.mass, shape.directions[0], remnant.spacing)
    return {
        "lobes": float(lobes.count),
        "largest_lobe_fraction": float(lobes.mass[0] / remnant.mass.sum()),
        "second_lobe_fraction": float(lobes.mass[1:2].sum() / remnant.mass.sum()),
    }


def _hull(remnant: Particles) -> Numbers:
    hull = hull_of(remnant.position)
    return {
        "hull_b_over_a": hull.ellipsoid.b_over_a,
        "hull_c_over_a": hull.ellipsoid.c_over_a,
        "hull_volume": hull.volume,
        **{f"extent_{name}": float(edge) for name, edge in zip("abc", hull.extents, strict=True)},
    }


def _interior(remnant: Particles) -> Numbers:
    low, median, high = np.percentile(remnant.J, [5.0, 50.0, 95.0])
    damaged = remnant.mass[remnant.damage > DAMAGED].sum() / remnant.mass.sum()
    return {"J_p05": float(low), "J_p50": float(median), "J_p95": float(high), "damaged_fraction": float(damaged)}


def _motion(remnant: Particles, bound: Particles) -> Numbers:
    """What moves inside the largest remnant and the bound mass, and what of the latter bears pressure."""
    compressed = bound.mass[bound.packing > bound.J].sum() / bound.mass.sum()
    return {"compressed_fraction": float(compressed)} | _flow(remnant, "flow") | _flow(bound, "bound_flow")


def _flow(particles: Particles, prefix: str) -> Numbers:
    flow = linear_flow(particles.position, particles.velocity, particles.mass)
    return {
        f"{prefix}_spin_rate": flow.spin_rate,
        f"{prefix}_strain_rate": flow.strain_rate,
        f"{prefix}_residual": flow.residual,
    }


def _settling(remnant: Particles, job: JobDirectory) -> Numbers:
    changes = recent_changes(remnant, job)
    return {
        "time_after_contact": remnant.time,
        "shape_change": changes.shape,
        "mass_change": changes.mass,
        "settled": changes.settled,
    }


def _line(text: object) -> str:
    return " ".join(str(text).split())
