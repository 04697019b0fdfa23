"""Simulations in Python, as in a notebook:

    from engine import Collision, open_scene

    simulation = open_scene(Collision(velocity=100.0, angle=15.0, particles=1000).scene())
    simulation.advance(until=2000.0)
    simulation.particles()  # an xarray Dataset

The first scene of a process fixes its precision (engine/device/options.py). Taichi has one program per process:
opening a scene ends all scenes opened before.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from engine import PHYSICS_VERSION
from engine.device.options import choose
from engine.scene.scene import Scene, scene_at

if TYPE_CHECKING:
    from engine.simulation.simulation import Simulation


class OpenScene:
    """A scene in memory that is advanced in time, without files and without the guard of jobs.

    Args:
        simulation: a started simulation.

    Attributes:
        scene: what is simulated.
        simulation: its state and its parts on the device.
    """

    def __init__(self, simulation: "Simulation") -> None:
        self.scene, self.simulation = simulation.scene, simulation

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.simulation.time

    def advance(self, until: float | None = None) -> None:
        """Advance to the first step that reaches a simulated time.

        Args:
            until: time [s]; the end of the scene if `None`, and at most that.

        Raises:
            GuardFault: a particle is outside the range in which the equations are valid.
        """
        end = self.scene.end_time if until is None else min(until, self.scene.end_time)
        while self.time < end:
            self.simulation.advance(end)

    def particles(self) -> xr.Dataset:
        """Return the particles at the present time, with the variables of final.nc."""
        from engine.job.snapshot import FIELDS, snapshot

        state = self.simulation.particles.read(*FIELDS)
        attributes = {"time": self.time, "spacing": self.scene.spacing, "physics_version": PHYSICS_VERSION}
        return snapshot(state, self.simulation.rho0(state), attributes)


def open_scene(scene: Scene | Path | str, arch: str = "cpu", threads: int | None = None) -> OpenScene:
    """Start Taichi in the precision of a scene, and build the scene at its start time.

    Args:
        scene: a scene, a scene file (TOML or JSON), or a job directory, which is only read.
        arch: `cpu`, `cuda`, `vulkan` or `gpu`.
        threads: CPU threads; all cores if `None`.

    Raises:
        SceneError: the scene cannot be read, the device is not available, or this process has another precision.
    """
    given = scene if isinstance(scene, Scene) else scene_at(Path(scene))
    choose(given.numerics.precision)
    from engine.device import backend  # only now: the precision is fixed by this import
    from engine.simulation.simulation import Simulation

    backend.start(arch, threads)
    simulation = Simulation(given)
    simulation.start()
    return OpenScene(simulation)
