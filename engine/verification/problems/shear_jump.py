"""A jump of tangential velocity in rubble that yields everywhere (engine/physics.md, sections 1 and 4)."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import inf

import numpy as np

from engine.simulation.initial_conditions import initial_state
from engine.simulation.simulation import LAUNCHES, Simulation
from engine.verification.check import Check
from engine.verification.harness import Array, Harness
from engine.verification.problems.slope import DEPTH, GRAVITY, Layer

SPEED = float(np.sqrt(GRAVITY * DEPTH))
"""Jump of velocity [m/s]: a twentieth of the speed of waves."""

SHARP = 4.0
"""Widest jump that passes [cells], whatever the number of steps: a body of 2,000 particles is 10 cells wide."""


@dataclass(frozen=True)
class ShearJump:
    """Upper half of a slope at its friction angle, which slides over the lower half: the jump of velocity stays a jump.

    Weight and friction balance at every depth, sqrt(J2) = mu P everywhere, so nothing drives, slows or widens the
    sliding except the transfer. In a fluid its filter spreads the jump, from 10 to 90 % of its height, over 2.2 and 2.8
    cells in 100 and 1,000 steps; in rubble, where friction opposes the overshoot of the filter, over 2.4 and 3.3 cells.
    With `apic` it is 4.6 and 8.2 cells.

    Attributes:
        steps: numbers of time steps after which the width is measured.
        layer: the slope.
    """

    name = "shear_jump"
    steps: tuple[int, ...] = (100, 1000)
    layer: Layer = field(default_factory=lambda: Layer(np.pi / 6.0, float(np.tan(np.pi / 6.0)), 32, end_time=1e3))

    def widths(self, harness: Harness) -> Iterator[tuple[float, float]]:
        """Yield the distance from 10 to 90 % of the jump [cells], and the scatter, after each number of steps.

        The scatter is the largest standard deviation of velocity at one depth, over the jump [-]: rubble that yields
        lets differences grow (section 4), and where they are large the layer breaks up and widens at once.
        """
        scene = self.layer.scene
        height = initial_state(scene)["x"][:, 2]
        depth = height + 0.5 * scene.dx
        v, upper = np.zeros((len(depth), 3)), depth > 0.5 * DEPTH
        v[upper, 0] = SPEED
        simulation = harness.start(scene, v=v, **self.layer.balance(depth))
        for steps in self.steps:
            with harness.timed():
                _advance_to(simulation, steps)
            z, mean, scatter = _profile(height, simulation.particles.read("v")["v"][:, 0] / SPEED)
            yield _width(z, mean) / scene.dx, float(scatter.max())

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the widths with the widest that passes, and show the scatter."""
        checks = []
        for steps, (width, scatter) in zip(self.steps, self.widths(harness), strict=True):
            checks.append(Check.absolute(f"width after {steps} steps", "cells", width, 0.0, SHARP))
            checks.append(Check.absolute(f"scatter at one depth after {steps} steps", "-", scatter, 0.0, inf))
        return checks


def _advance_to(simulation: Simulation, steps: int) -> None:
    while simulation.step < steps:
        simulation.advance(simulation.scene.end_time, min(LAUNCHES, steps - simulation.step))


def _profile(height: Array, value: Array) -> tuple[Array, Array, Array]:
    """Heights of the layers of particles, and mean and standard deviation in each."""
    heights, layer = np.unique(height, return_inverse=True)
    mean = np.bincount(layer, value) / np.bincount(layer)
    return heights, mean, np.sqrt(np.bincount(layer, (value - mean[layer]) ** 2) / np.bincount(layer))


def _width(z: Array, value: Array) -> float:
    """Distance between the values 0.1 and 0.9 that are nearest to the middle, in the unit of z."""
    middle = int(np.searchsorted(z, 0.5 * (z[0] + z[-1])))
    low = int(np.flatnonzero(value[:middle] < 0.1)[-1])
    high = middle + int(np.flatnonzero(value[middle:] > 0.9)[0])
    bottom = np.interp(0.1, value[low : low + 2], z[low : low + 2])
    top = np.interp(0.9, value[high - 1 : high + 1], z[high - 1 : high + 1])
    return float(top - bottom)
