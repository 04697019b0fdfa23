"""What each law costs: `python -m tests.benchmarks.laws` steps the same state with one part of physics more or less."""

from collections.abc import Callable
from typing import Any

import numpy as np
import taichi as ti
from rich.console import Console
from rich.table import Table

from engine import backend
from engine.backend import mat3, overwrite, vec3, vec6
from engine.particles import Arrays
from engine.scene import Scene, Viscosity, Wall
from engine.simulation import Simulation
from engine.tensors import deviator, half_log, unpack
from tests.benchmarks.contact import in_contact, take_step
from tests.benchmarks.scene import collision
from tests.benchmarks.stopwatch import Stopwatch
from tests.benchmarks.stretch import deformation_gradient

PARTICLES = 20_000
MOMENTS = {"before contact": -20.0, "100 s after contact": 100.0}
ROUNDS = 12
BATCH = 5
"""Steps that one variant takes in its turn."""

BASIS = "all laws of a collision"
VARIANTS: dict[str, dict[str, Any]] = {
    BASIS: {},
    "without growth of damage": {"fracture": None},
    "and without strength": {"fracture": None, "strength": False},
    "and without shear": {"fracture": None, "strength": False, "shear": False},
    "with viscosity": {"viscosity": Viscosity(shear=1e3, bulk=1e3, shock_linear=1.0, shock_quadratic=2.0)},
    "with a wall": {"walls": (Wall(point=(0.0, 0.0, -1e6)),)},
}
"""Changes of the scene's physics."""


def variant(simulation: Simulation, changes: dict[str, Any]) -> Simulation:
    """The same particles at the same time, with other physics; damage stays a state where it does not grow."""
    scene = simulation.scene
    physics = scene.physics.model_copy(update=changes)
    bodies = scene.bodies
    if physics.strength and not physics.fracture:
        bodies = tuple(body.model_copy(update={"damage": 1.0}) for body in bodies)
    changed = Simulation(scene.model_copy(update={"physics": physics, "bodies": bodies}))
    changed.start(**held(simulation, changed))
    for name in ("time", "rate", "pause_time"):
        getattr(changed.clock, name)[None] = getattr(simulation.clock, name)[None]
    return changed


def held(simulation: Simulation, other: Simulation) -> Arrays:
    """State of those quantities that the other holds too."""
    return simulation.particles.read(*other.particles.held)


def time_laws(scene: Scene, moment: float) -> dict[str, Stopwatch]:
    """Times of batches of steps, in turns."""
    reference = in_contact(scene, moment)
    simulations = {name: variant(reference, changes) for name, changes in VARIANTS.items()}
    watches = {name: Stopwatch() for name in simulations}
    for simulation in simulations.values():
        take_step(simulation)
    for _ in range(ROUNDS):
        for name, simulation in simulations.items():
            with watches[name].lap():
                for _ in range(BATCH):
                    take_step(simulation)
    return watches


@ti.data_oriented
class LogStrain:
    """Deviatoric logarithmic strain of the same particles, from F by its singular values and from F F^T - I.

    Args:
        state: B and j of every particle.
    """

    def __init__(self, state: Arrays) -> None:
        self.count = len(state["j"])
        self.F, self.B = mat3.field(shape=self.count), vec6.field(shape=self.count)
        self.result = mat3.field(shape=self.count)
        overwrite(self.F, deformation_gradient(state))
        overwrite(self.B, state["B"])

    @ti.kernel
    def by_svd(self):
        """U dev(ln Sigma) U^T."""
        for p in range(self.count):
            U, S, _ = ti.svd(self.F[p])
            logs = vec3(ti.log(S[0, 0]), ti.log(S[1, 1]), ti.log(S[2, 2]))
            logs -= logs.sum() / 3.0
            self.result[p] = U @ mat3(logs[0], 0, 0, 0, logs[1], 0, 0, 0, logs[2]) @ U.transpose()

    @ti.kernel
    def by_series(self):
        """The engine's way."""
        for p in range(self.count):
            self.result[p] = deviator(half_log(unpack(self.B[p])))


def strains(count: int, size: float) -> Arrays:
    """Random isochoric strains of one size."""
    generator = np.random.default_rng(1)
    logs = generator.normal(size=(count, 3))
    logs -= logs.mean(axis=1, keepdims=True)
    logs *= size / np.linalg.norm(logs, axis=1, keepdims=True)
    axes, _ = np.linalg.qr(generator.normal(size=(count, 3, 3)))
    B = np.einsum("nik,nk,njk->nij", axes, np.expm1(2.0 * logs), axes)
    return {"B": B[:, [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]], "j": np.zeros(count)}


def time_log_strain(size: float) -> tuple[Stopwatch, Stopwatch, float]:
    """Times by singular values and by series, and the largest difference in units of the strain."""
    law = LogStrain(strains(2 * PARTICLES, size))
    law.by_svd()
    expected = law.result.to_numpy()
    law.by_series()
    difference = float(np.abs(law.result.to_numpy() - expected).max()) / size
    watches = Stopwatch(), Stopwatch()
    for _ in range(ROUNDS):
        for watch, kernel in zip(watches, (law.by_svd, law.by_series), strict=True):
            _lap(watch, kernel)
    return *watches, difference


def _lap(watch: Stopwatch, kernel: Callable[[], None]) -> None:
    with watch.lap():
        kernel()


def main() -> None:
    """Print both tables: CPU time on one thread, medians of turns."""
    console = Console(width=110)
    table = Table(f"ms a step of {2 * PARTICLES:,} particles", *MOMENTS, *(f"difference {m}" for m in MOMENTS))
    columns = []
    for moment in MOMENTS.values():
        backend.start(threads=1)
        watches = time_laws(collision(PARTICLES), moment)
        columns.append({name: 1e3 * np.median(watch.cpu) / BATCH for name, watch in watches.items()})
    for name in VARIANTS:
        costs = [column[name] for column in columns]
        changes = [column[name] - column[BASIS] for column in columns]
        table.add_row(name, *(f"{cost:.2f}" for cost in costs), *(f"{change:+.2f}" for change in changes))
    console.print(table)
    table = Table("strain", "ti.svd [ms]", "engine [ms]", "ratio", "largest difference")
    for size in (1e-4, 1e-2, 0.1):
        backend.start(threads=1)
        svd, series, difference = time_log_strain(size)
        old, new = (1e3 * float(np.median(watch.cpu)) for watch in (svd, series))
        table.add_row(f"{size:g}", f"{old:.2f}", f"{new:.2f}", f"{old / new:.1f}", f"{difference:.1e}")
    console.print(table)


if __name__ == "__main__":
    main()
