"""Elastic waves in a laterally confined column (engine/physics.md, sections 1-3)."""

from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.optimize import curve_fit

from engine.scene.bodies import Box
from engine.scene.material import named
from engine.scene.scene import Numerics, Physics, Scene
from engine.simulation.initial_conditions import initial_state
from engine.verification.check import Check
from engine.verification.harness import Array, Harness, fitted_order


@dataclass(frozen=True)
class Oscillation:
    """A measured wave, v ~ exp(-gamma t) cos(omega t + phase).

    Attributes:
        speed: phase speed [m/s].
        damping: gamma [1/s].
    """

    speed: float
    damping: float


@dataclass(frozen=True)
class StandingWave:
    """One wavelength of a standing longitudinal wave, periodic along all axes.

    Attributes:
        cells: cells along the wavelength, a multiple of four.
        length: wavelength [m].
        amplitude: of velocity [m/s]; the strain stays near 1e-7.
        periods: duration in exact periods.
        sound_speed: factor on the speed of sound.
    """

    cells: int
    length: float = 1000.0
    amplitude: float = 1e-3
    periods: float = 1.0
    sound_speed: float = 1.0

    @property
    def dx(self) -> float:
        """Grid spacing [m]."""
        return self.length / self.cells

    @property
    def period(self) -> float:
        """Exact period [s], wavelength over sqrt((K + 4G/3)/rho)."""
        return self.length / (self.sound_speed * named("basalt").longitudinal_speed)

    @property
    def scene(self) -> Scene:
        """Intact basalt, two particles a cell along the wave and one across."""
        size = (self.length, 4.0 * self.dx, 4.0 * self.dx)
        centre = (0.5 * size[0], 0.5 * size[1], 0.5 * size[2])
        return Scene(
            bodies=(Box(size=size, lattice=(2 * self.cells, 4, 4), position=centre),),
            period=size,
            end_time=self.periods * self.period,
            physics=Physics(strength=False, fracture=None, gravity=None, sound_speed=self.sound_speed),
            numerics=Numerics(particles_per_cell=2.0),
        )

    def measure(self, harness: Harness) -> Oscillation:
        """Fit a damped oscillation to the amplitude of a run, by least squares."""
        times, amplitudes = self.amplitudes(harness)
        guess = (2.0 * np.pi / self.period, 0.0, self.amplitude, 0.0)
        (omega, gamma, _, _), _ = curve_fit(_damped, times, amplitudes, p0=guess)
        return Oscillation(float(omega) * self.length / (2.0 * np.pi), float(gamma))

    def amplitudes(self, harness: Harness) -> tuple[Array, Array]:
        """Return 65 times [s] and the amplitude of velocity at them [m/s], 2 <v_x sin(k x)>."""
        scene = self.scene
        x = initial_state(scene)["x"][:, 0]
        k = 2.0 * np.pi / self.length
        C = np.zeros((len(x), 3, 3))
        C[:, 0, 0] = self.amplitude * k * np.cos(k * x)
        wave = np.stack([self.amplitude * np.sin(k * x), 0.0 * x, 0.0 * x], axis=1)
        simulation = harness.start(scene, v=wave, C=C)
        states = [harness.run_until(simulation, time) for time in np.linspace(0.0, scene.end_time, 65)]
        projected = [2.0 * float(np.mean(state.v[:, 0] * np.sin(k * x))) for state in states]
        return np.array([state.time for state in states]), np.array(projected)


@dataclass(frozen=True)
class Column:
    """Speed of longitudinal waves, and how fast its error falls with dx.

    Attributes:
        cells: resolutions, in cells per wavelength.
    """

    name = "column"
    cells: tuple[int, ...] = (8, 16, 32)

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the speed at the finest resolution and its order of convergence; show the damping."""
        waves = [StandingWave(cells) for cells in self.cells]
        exact = named("basalt").longitudinal_speed
        measured = [wave.measure(harness) for wave in waves]
        errors = [abs(wave.speed - exact) for wave in measured]
        order = fitted_order([wave.dx for wave in waves], errors)
        damping = measured[-1].damping * waves[-1].period
        return [
            Check.relative(f"speed, {self.cells[-1]} cells per wavelength", "m/s", measured[-1].speed, exact, 0.01),
            Check.absolute("amplitude lost in one period", "-", 1.0 - float(np.exp(-damping)), 0.0, inf),
            Check("order of the speed in dx", "-", order, 2.0, max(0.0, 2.0 - order), 0.3),
        ]


def _damped(t: Array, omega: float, gamma: float, amplitude: float, phase: float) -> Array:
    return np.asarray(amplitude * np.exp(-gamma * t) * np.cos(omega * t + phase))
