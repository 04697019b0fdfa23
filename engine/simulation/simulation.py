"""Simulation of a scene: its parts on the device, its steps, and the events between them."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields

import numpy as np
from numpy.typing import NDArray

from engine.arrays import Scalars
from engine.constants import BLOCK_EDGE
from engine.device.backend import require_precision
from engine.errors import SMALLER_STEPS, stop
from engine.gravity.self_gravity import SelfGravity
from engine.mpm.block_coordinates import HALF_RANGE
from engine.mpm.blocks import Blocks
from engine.mpm.response import Response
from engine.mpm.stencil import Stencil
from engine.mpm.tiles import Tiles
from engine.mpm.time_step import first_rate
from engine.mpm.transfer import Transfer
from engine.scene.scene import Scene
from engine.simulation import assembly
from engine.simulation.conservation import Totals
from engine.simulation.initial_conditions import initial_state
from engine.state.clock import FAULT_NONE, Clock
from engine.state.particles import Arrays, Particles

LAUNCHES = 64
"""Most steps that are launched before the host checks whether they ran."""


@dataclass(frozen=True)
class Events:
    """Times of what happens between steps, and results of its last occurrence.

    Attributes:
        gravity_due: simulated time [s] at which self-gravity is next computed; infinite without self-gravity.
        gravity_change: relative change of the acceleration between its last two computations [-].
        gravity_force, gravity_torque: relative net force and torque removed [-], see `NetForce`.
    """

    gravity_due: float
    gravity_change: float = 0.0
    gravity_force: float = 0.0
    gravity_torque: float = 0.0


class Simulation:
    """All parts of a scene on the device, and the events between steps.

    Args:
        scene: what to simulate; Taichi must have been started.

    Attributes:
        particles, clock: state on the device.
        constitution, gravity, walls: physics of the scene.
        ledger: sums over all particles.
        blocks, tiles: order of the particles, and which blocks share nodes.
        stencil, transfer: the grid and the kernels of a step.
        events: times of what happens between steps.

    Raises:
        SceneError: this process has another precision than the scene.
    """

    def __init__(self, scene: Scene) -> None:
        require_precision(scene.numerics.precision)
        self.scene, physics = scene, scene.physics
        self.particles = Particles(scene.particles)
        longest = physics.gravity.interval if physics.gravity else scene.end_time - scene.start_time
        self.clock = Clock(scene.start_time, scene.end_time, longest)
        self.gravity = assembly.gravity(scene, self.particles)
        self.constitution = assembly.constitution(scene, self.particles)
        self.walls = assembly.walls(scene)
        self.response = Response(self.particles, self.constitution, self.gravity, self.walls, self.clock, scene.dx)
        self.scheme = assembly.scheme(scene, self.response)
        self.contact = assembly.contact(scene)
        self.ledger = assembly.ledger(scene, self.particles, self.gravity, self.scheme)
        self.blocks = Blocks(self.particles, scene.dx, scene.period_blocks, scene.separates_bodies)
        self.tiles = Tiles(self.blocks)
        self._make_room(scene.particles // 8)
        self.events = Events(gravity_due=scene.start_time if physics.gravity else math.inf)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return float(self.clock.time[None])

    @property
    def step(self) -> int:
        """Time steps done."""
        return int(self.clock.step[None])

    @property
    def finished(self) -> bool:
        """Whether the end time is reached."""
        return self.time >= self.scene.end_time

    def start(self, **changes: NDArray[np.generic]) -> None:
        """Set the initial state of the scene.

        Args:
            changes: whole fields of the particles that replace the scene's own, shape [particle_count, ...].
        """
        self.particles.write({**initial_state(self.scene), "half_step_work": np.zeros(self.scene.particles), **changes})
        self.rebuild_blocks()
        self.clock.dt[None] = 0.0
        self.clock.rate[None] = self._first_rate(self.particles.read("C", "tau", "body"))

    def advance(self, until: float, steps: int = LAUNCHES) -> None:
        """Advance by some steps, at most to the first that reaches a time.

        The steps depend on the scene alone, not on the calls of this method.

        Args:
            until: simulated time [s].
            steps: most steps.

        Raises:
            GuardFault: a particle is outside the range in which the equations are valid.
        """
        self._handle_events()
        self.clock.pause_time[None] = min(until, self.events.gravity_due, self.scene.end_time)
        self._launch(steps)
        self._check_fault()

    def rebuild_blocks(self) -> None:
        """Sort particles into the blocks they are in now.

        Raises:
            GuardFault: a particle is beyond the range of block coordinates.
        """
        if not self.blocks.find():
            self._stop_beyond_range()
        self._build_blocks()

    def clock_state(self) -> dict[str, float | int]:
        """Return what later steps depend on beside the particles: the clock and the events."""
        return {**self.clock.read(), **asdict(self.events)}

    def restore(self, particles: Arrays, clock_state: Mapping[str, float | int]) -> None:
        """Set the state between two steps of an earlier simulation of the same scene.

        Args:
            particles: all fields that this scene allocates.
            clock_state: what `clock_state` returned at the same time.
        """
        self.particles.write(particles)
        self._build_blocks()
        self.clock.write(clock_state)
        self.events = Events(**{field.name: clock_state[field.name] for field in fields(Events)})

    def _build_blocks(self) -> None:
        """Build the blocks from where the particles were when blocks were last built."""
        blocks, alone = self.blocks.sort()
        if blocks > self.stencil.capacity:
            self._make_room(2 * blocks)
        self.blocks.write(self.stencil, blocks, alone)
        self.tiles.write(self.stencil)
        self.clock.moved_out[None] = 0

    def _make_room(self, blocks: int) -> None:
        self.stencil = Stencil(self.particles, self.scene.dx, blocks)
        self.transfer = Transfer(self.stencil, self.scheme, self.contact, self.clock, self.scene.numerics.cfl)

    def _handle_events(self) -> None:
        if self.clock.moved_out[None]:
            self.rebuild_blocks()
        if self.time >= self.events.gravity_due:
            self._update_gravity()

    def _update_gravity(self) -> None:
        assert isinstance(self.gravity, SelfGravity) and self.scene.physics.gravity
        interval, dt = self.scene.physics.gravity.interval, self.next_dt
        # mean time of the kicks that will use it: a step kicks from where particles are when it begins
        removed = self.gravity.accelerate(ahead=0.5 * dt * (math.ceil(interval / dt) - 1))
        self.events = Events(self.time + interval, removed.change, removed.force, removed.torque)

    def _launch(self, most: int) -> None:
        left = self.clock.pause_time[None] - self.time
        for _ in range(min(most, math.ceil(left / self.next_dt) + 1)):
            self.transfer.step()

    @property
    def next_dt(self) -> float:
        """The next time step [s]."""
        return float(1.0 / max(self.clock.rate[None], self.clock.least_rate[None]))

    @property
    def first_dt(self) -> float:
        """The time step [s] that the scene begins with."""
        return float(1.0 / max(self._first_rate(initial_state(self.scene)), self.clock.least_rate[None]))

    def _first_rate(self, state: Arrays) -> float:
        return first_rate(self.scene, state, self.rho0(state))

    def _check_fault(self) -> None:
        if self.clock.fault[None] != FAULT_NONE:
            p = int(self.clock.fault_particle[None])
            j = float(self.particles.read("j")["j"][p])
            raise stop("det F", 1.0 + j, "above 0", self.time, p, advice=SMALLER_STEPS)

    def _stop_beyond_range(self) -> None:
        x = np.abs(self.particles.read("x")["x"]).max(axis=1)
        p, largest = int(np.argmax(x)), BLOCK_EDGE * HALF_RANGE * self.scene.dx
        advice = "end the run earlier, or make cells larger"
        raise stop("coordinate [m]", float(x[p]), f"below {largest:.3g}", self.time, p, advice=advice)

    def totals(self) -> Totals:
        """Return the conserved quantities at the present time."""
        return self.ledger.totals(float(self.clock.dt[None]))

    def rho0(self, state: Arrays) -> Scalars:
        """Return the reference density of every particle [kg/m^3], shape [particle_count].

        Args:
            state: field body of every particle.
        """
        return np.array([body.material.rho0 for body in self.scene.bodies])[state["body"]]
