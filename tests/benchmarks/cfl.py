"""How long a time step may be: `python -m tests.benchmarks.cfl` scans the Courant number of two collisions."""

from collections.abc import Iterator
from dataclasses import dataclass

from rich.console import Console
from rich.table import Table

from engine.device import backend
from engine.errors import RunFault
from engine.scene.collision import Collision
from engine.scene.scene import Scene
from engine.simulation.conservation import Totals
from engine.simulation.simulation import Simulation
from engine.verification.harness import altered

PARTICLES = 1_000
COURANT = (0.1, 0.15, 0.25, 0.35, 0.5, 0.6, 0.7, 0.85, 1.0, 1.25, 1.5)
PASSAGE = 2.0
"""End of a run, in times that the impact speed needs for the radius of a body."""
ROWS = 50
"""Moments of a run at which its energy is looked at."""
TITLES = ("v [m/s]", "cfl", "steps", "largest growth", "dissipated", "kinetic left", "damage", "end")


@dataclass
class Outcome:
    """One run.

    Attributes:
        steps: time steps.
        growth: largest rise of the total energy above its start, as a share of the kinetic energy at the start [-].
        dissipated: total energy lost at the end, likewise [-].
        kinetic: kinetic energy left at the end, likewise [-].
        damage: mean damage at the end [-].
        fault: what stopped it, or nothing.
    """

    steps: int = 0
    growth: float = 0.0
    dissipated: float = 0.0
    kinetic: float = 1.0
    damage: float = 0.0
    fault: str = ""

    def look(self, simulation: Simulation, start: Totals) -> None:
        """Take note of a moment."""
        now = simulation.totals()
        change = (now.total_energy - start.total_energy) / start.kinetic_energy
        self.growth, self.dissipated = max(self.growth, change), -change
        self.kinetic = now.kinetic_energy / start.kinetic_energy
        self.damage = float((simulation.particles.read("damage_root")["damage_root"] ** 3).mean())


def scene(velocity: float, cfl: float) -> Scene:
    """An oblique collision without gravity; `cfl` may exceed what a scene file may ask for."""
    given = Collision(velocity=velocity, angle=15.0, particles=PARTICLES, gravity=None, start_separation=1.05)
    end = PASSAGE * given.radius / velocity
    return altered(given.model_copy(update={"end_time": end}).scene(), "numerics.cfl", cfl)


def collide(velocity: float, cfl: float) -> Outcome:
    """Run one collision and watch its energy."""
    simulation, outcome = Simulation(scene(velocity, cfl)), Outcome()
    simulation.start()
    start, begun = simulation.totals(), simulation.time
    try:
        for row in range(1, ROWS + 1):
            until = begun + (simulation.scene.end_time - begun) * row / ROWS
            while simulation.time < until:
                simulation.advance(until)
            outcome.look(simulation, start)
    except RunFault as fault:
        outcome.fault = str(fault).split(";")[0]
    outcome.steps = simulation.step
    return outcome


def scan() -> Iterator[tuple[str, ...]]:
    """Rows of the table."""
    for velocity in (200.0, 2000.0):
        for cfl in COURANT:
            backend.start(threads=1)
            o = collide(velocity, cfl)
            shares = (f"{100.0 * share:.2f} %" for share in (o.growth, o.dissipated, o.kinetic, o.damage))
            yield f"{velocity:g}", f"{cfl:g}", f"{o.steps}", *shares, o.fault or "whole"


if __name__ == "__main__":
    table = Table(*TITLES)
    for row in scan():
        table.add_row(*row)
    Console(width=150).print(table)
