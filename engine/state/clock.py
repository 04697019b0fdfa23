"""Clock on the device: time, time step and reasons to pause, so that steps do not wait for the host."""

import math
from collections.abc import Mapping

import taichi as ti

from engine.device.backend import Real
from engine.device.fields import allocate

FAULT_NONE = 0
FAULT_INVERTED = 1
"""Fault of a particle with det F <= 0."""


LARGEST_STRETCH = 1.25
"""Largest ratio of a time step to the one before it."""

LARGEST_DROP = 2.0
"""Largest ratio of a time step to the one after it at which forces act from middle to middle. Where stress appears at
once, the longer step did not know of it.
"""


@ti.data_oriented
class Clock:
    """Time, and the time step, which follows from the highest rate that the step before reported, and grows slowly.

    A step does nothing once `pause_time` is reached, a particle is out of its block, or there is a fault. The host may
    therefore launch more steps than are run; results do not depend on how many.

    Args:
        start: first simulated time [s].
        end: last simulated time [s]; the last step ends on it exactly.
        longest_step: upper bound of the time step [s].

    Attributes:
        time, end, pause_time: simulated time [s] now, of the end, and up to which steps run.
        contact_time: end of the first step in which two bodies touched [s]; infinite before.
        dt: length of the last step [s].
        kick: time in which forces act [s], from the middle of the step before to the middle of this one.
        rate, least_rate: inverse of the next time step [1/s], and its lower bound.
        step: number of steps done.
        running: 1 during a step that runs, 0 during one that does nothing.
        moved_out: 1 if a particle is out of its block.
        fault, fault_particle: kind of a fault, and number of the particle in the scene.
        kept: fields that later steps depend on, by name.
    """

    def __init__(self, start: float, end: float, longest_step: float) -> None:
        self.time, self.end, self.pause_time, self.contact_time = (allocate(ti.f64) for _ in range(4))
        self.dt, self.kick, self.rate, self.least_rate = (allocate(Real) for _ in range(4))
        self.step, self.running, self.moved_out = (allocate(ti.i32) for _ in range(3))
        self.fault, self.fault_particle = allocate(ti.i32), allocate(ti.i32)
        self.time[None], self.end[None], self.pause_time[None] = start, end, start
        self.contact_time[None] = math.inf
        self.least_rate[None] = 1.0 / longest_step
        self.fault_particle[None] = 2**31 - 1
        self.kept = {
            "time": self.time,
            "contact_time": self.contact_time,
            "dt": self.dt,
            "rate": self.rate,
            "step": self.step,
            "moved_out": self.moved_out,
        }

    def read(self) -> dict[str, float | int]:
        """Return the fields that later steps depend on, by name."""
        return {name: field[None] for name, field in self.kept.items()}

    def write(self, values: Mapping[str, float | int]) -> None:
        """Set the fields that `read` returns."""
        for name, field in self.kept.items():
            field[None] = values[name]

    @ti.func
    def begin_step(self):
        """Set `running`, and, if the step runs, its length and the time after it."""
        self.running[None] = 0
        if self.time[None] < self.pause_time[None] and self.moved_out[None] == 0 and self.fault[None] == FAULT_NONE:
            self.running[None] = 1
            left = self.end[None] - self.time[None]
            dt = 1.0 / ti.max(self.rate[None], self.least_rate[None])
            before, self.dt[None] = self.dt[None], ti.min(dt, left)
            self.kick[None] = 0.5 * (self.dt[None] + ti.min(before, LARGEST_DROP * dt))
            self.time[None] += self.dt[None]
            if dt >= left:
                self.time[None] = self.end[None]
            self.step[None] += 1
            self.rate[None] = 1.0 / (LARGEST_STRETCH * dt)

    @ti.func
    def report_rate(self, rate):
        """Report an inverse time step [1/s] that the next step must not fall below."""
        ti.atomic_max(self.rate[None], rate)

    @ti.func
    def report_contact(self):
        """Keep the time at which bodies first touch."""
        if self.contact_time[None] > self.time[None]:
            self.contact_time[None] = self.time[None]

    @ti.func
    def report_moved_out(self):
        """Pause before the next step, for new blocks."""
        self.moved_out[None] = 1

    @ti.func
    def report_fault(self, fault, p):
        """Stop the run because of particle p; the lowest index is kept."""
        self.fault[None] = fault
        ti.atomic_min(self.fault_particle[None], p)
