"""Guard of a run: checks its state against bounds that follow from the scene (engine/physics.md, section 13).

A check reads the state and changes nothing.
"""

import math

import numpy as np
from numpy.typing import NDArray

from engine.device.backend import EPSILON
from engine.errors import SMALLER_STEPS, stop
from engine.mpm.time_step import rate_of_motion
from engine.scene.scene import Scene
from engine.simulation.bounds import (
    compression_limit,
    dissipates,
    energy_growth,
    keeps_energy,
    keeps_momentum,
    largest_energy_change,
    momentum_drift,
    speed_scale,
)
from engine.simulation.conservation import Row
from engine.simulation.ledger import Extremes
from engine.state.particles import Arrays, Particles

SPEED_FACTOR = 10.0
"""Largest speed in units of the scene's [-]: rebounds reach two or three of them, jets a few."""

LARGEST_DRIFT = max(1e6 * float(np.finfo(np.float64).eps), 1e3 * EPSILON)
"""Largest change of the total momentum in units of mass times the scene's speeds [-]."""

ROUND_OFF = 1e-11
"""Of a sum of masses in another order [-]: history that an earlier version began was summed in one."""

STEPS_FACTOR = 1e4
"""Most time steps of a run, in units of its length over its first step [-]."""

LOOK_CLOSER = "a smaller output.history_interval shows what grew first, and when"
"""Advice for a state that is not finite or has no time step: what grew first was not checked in time."""


class Guard:
    """Bounds of one run.

    Args:
        scene: what is simulated.
        start: first row of the run's history.
        dt: first time step [s].

    Attributes:
        speed: largest speed [m/s].
        compression: largest rho/rho0 [-].
        energy_change: largest change of the total energy in the measure of `energy_growth` [-].
        momentum: scale of the total momentum [kg m/s].
        shortest_step: shortest time step [s].
    """

    def __init__(self, scene: Scene, start: Row, dt: float) -> None:
        self.scene, self.start, self.shortest_step = scene, start, dt / STEPS_FACTOR
        scale, materials = speed_scale(scene, start), set(scene.materials)
        self.speed = SPEED_FACTOR * scale
        self.compression = max(compression_limit(material, 0.5 * self.speed**2) for material in materials)
        self.energy_change = largest_energy_change(scene)
        self.momentum = float(start["mass"]) * (scale + max(material.longitudinal_speed for material in materials))

    def check(self, row: Row, extremes: Extremes, particles: Particles) -> None:
        """Check a row of the history and all particles at the same time.

        Args:
            row: conserved quantities.
            extremes: of all particles.
            particles: of which a fault names one.

        Raises:
            GuardFault: a quantity is outside its bounds.
        """
        time, fast = float(row["time"]), extremes.speed > self.speed
        if fast or extremes.compression > self.compression or not extremes.is_finite:
            self.check_particles(particles.read(), time)
        _require_finite_row(row, time)
        self._check_mass(row, time)
        self._check_momentum(row, time)
        self._check_energy(row, time)

    def check_particles(self, state: Arrays, time: float) -> None:
        """Check all particles.

        Args:
            state: all their fields.
            time: simulated time [s].

        Raises:
            GuardFault: names the first that is outside its bounds.
        """
        require_finite(state, time)
        _require_at_most("speed [m/s]", np.linalg.norm(state["v"], axis=1), self.speed, time)
        dilation = state["plastic_dilation"]
        _require_at_most("rho/rho0", (1.0 + dilation) / (1.0 + state["j"]), self.compression, time)

    def check_time_step(self, dt: float, time: float, particles: Particles) -> None:
        """Check the next time step.

        Args:
            dt: time step [s].
            time: simulated time [s].
            particles: of which a fault names the one that demands the shortest step.

        Raises:
            GuardFault: the step is shorter than the shortest one.
        """
        if not dt >= self.shortest_step:
            state = particles.read("v", "C")
            particle = int(np.argmax(rate_of_motion(state, self.scene.dx)))
            allowed = f"at least {self.shortest_step:.3g}"
            raise stop("time step [s]", dt, allowed, time, particle, advice=LOOK_CLOSER)

    def _check_mass(self, row: Row, time: float) -> None:
        mass, expected = float(row["mass"]), float(self.start["mass"])
        if not abs(mass - expected) <= ROUND_OFF * expected:
            advice = "particles were changed from outside: run the scene in a new directory"
            raise stop("total mass [kg]", mass, f"{expected!r}", time, advice=advice)

    def _check_momentum(self, row: Row, time: float) -> None:
        drift, allowed = momentum_drift(row, self.start), LARGEST_DRIFT * self.momentum
        if keeps_momentum(self.scene) and not drift <= allowed:
            advice = 'only round-off changes it, at any time step: use numerics.precision = "f64"'
            raise stop("change of total momentum [kg m/s]", drift, f"at most {allowed:.3g}", time, advice=advice)

    def _check_energy(self, row: Row, time: float) -> None:
        growth, most = energy_growth(self.scene, row, self.start), self.energy_change
        least = -1.0 if dissipates(self.scene) else -most  # all energy may be lost
        if keeps_energy(self.scene) and not least <= growth <= most:
            allowed = f"between {least:.3g} and {most:.3g}"
            quantity = "growth of total energy, as a fraction of all energies"
            raise stop(quantity, growth, allowed, time, advice=SMALLER_STEPS)


def require_finite(state: Arrays, time: float) -> None:
    """Check that all numbers are finite.

    Args:
        state: fields of every particle.
        time: simulated time [s].

    Raises:
        GuardFault: names the first field that is not, and its first particle.
    """
    for name, values in state.items():
        bad = ~np.isfinite(values).reshape(len(values), -1).all(axis=1)
        if bad.any():
            raise stop(name, math.nan, "finite", time, int(np.argmax(bad)), advice=LOOK_CLOSER)


def _require_finite_row(row: Row, time: float) -> None:
    """Check that all totals are finite: sums of finite numbers may overflow, and NaN passes every comparison."""
    for name, value in row.items():
        if not np.isfinite(value).all():
            raise stop(name, math.nan, "finite", time, advice=LOOK_CLOSER)


def _require_at_most(quantity: str, values: NDArray[np.float64], limit: float, time: float) -> None:
    particle = int(np.argmax(values))
    if values[particle] > limit:
        raise stop(quantity, float(values[particle]), f"at most {limit:.4g}", time, particle, advice=SMALLER_STEPS)
