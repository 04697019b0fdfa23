"""The tradeoff of each verification scene: its resolutions and settings, and the error that they lead to."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from engine.scene.material import named
from engine.verification.check import Problem
from engine.verification.harness import Harness, Setting
from engine.verification.problems.bar import Pull
from engine.verification.problems.cliff import Cliff
from engine.verification.problems.collapse import Fall
from engine.verification.problems.column import StandingWave
from engine.verification.problems.expansion import Expansion
from engine.verification.problems.hugoniot import Impact, Shock
from engine.verification.problems.hydrostatic import Hydrostatic
from engine.verification.problems.infall import Infall
from engine.verification.problems.rotation import Rotation
from engine.verification.problems.rubble import Rubble
from engine.verification.problems.slope import Layer

FINE_STEPS = 16000
"""Time steps of the independent integration that bars are compared with."""

Settings = Mapping[str, tuple[Setting, ...]]
"""Values to try, by dotted key of a scene."""

COMMON: Settings = {"numerics.cfl": (0.1, 0.3, 0.6, 0.9), "numerics.precision": ("f64", "f32")}
CELLS: Settings = {"numerics.particles_per_cell": (2.0, 4.0, 8.0)}
GRAVITY: Settings = {
    "physics.gravity.interval": (5.0, 10.0, 20.0, 40.0, 80.0),
    "physics.gravity.opening": (0.2, 0.5, 0.8),
}
SOUND: Settings = {"physics.sound_speed": (1.0, 0.5, 0.25)}


@dataclass(frozen=True)
class Tradeoff:
    """One scene, its error as a function of resolution, and the settings to vary.

    Attributes:
        quantity: what the error is of, and in which unit.
        error: runs the scene in a harness at a resolution and returns the size of the error.
        resolution: what a resolution counts: `particles`, `cells` or `steps`.
        resolutions: values of it; the first is used while a setting is varied.
        settings: values of the other settings by dotted key of the scene.
    """

    quantity: str
    error: Callable[[Harness, int], float]
    resolution: str
    resolutions: tuple[int, ...]
    settings: Settings

    @property
    def runs(self) -> list[tuple[str, Setting]]:
        """The one setting that a run varies, and its value; the resolution counts as a setting."""
        varied = {self.resolution: self.resolutions, **self.settings}
        return [(setting, value) for setting, values in varied.items() for value in values]


def _relative(measured: float, exact: float) -> float:
    return abs(measured / exact - 1.0)


def _wave(harness: Harness, cells: int) -> float:
    return _relative(StandingWave(cells).measure(harness).speed, named("basalt").longitudinal_speed)


def _fall(harness: Harness, particles: int) -> float:
    fall = Fall(particles)
    return _relative(fall.measure(harness), fall.collapse_time)


def _shock(harness: Harness, cells: int) -> float:
    return _relative(Impact(500.0, cells).measure(harness)["P"], float(Shock(500.0).P))


def _layer(harness: Harness, cells: int) -> float:
    layer = Layer(float(np.deg2rad(35.0)), float(np.tan(np.deg2rad(30.0))), cells)
    return _relative(layer.slide(harness).acceleration, layer.acceleration)


def _bar(harness: Harness, steps: int) -> float:
    exact = Pull(10.0, steps=FINE_STEPS).reference().max()
    return _relative(float(Pull(10.0, steps=steps).engine(harness).max()), float(exact))


def _error_of(quantity: str, problem: Callable[[int], Problem]) -> Callable[[Harness, int], float]:
    """Error of one quantity that a problem checks, as a function of resolution."""

    def error(harness: Harness, resolution: int) -> float:
        checks = problem(resolution).checks(harness)
        return float(next(check.error for check in checks if check.quantity == quantity))

    return error


TRADEOFFS: dict[str, Tradeoff] = {
    "column": Tradeoff("speed of a wave, relative", _wave, "cells", (16, 8, 32, 64), COMMON),
    "hugoniot": Tradeoff("pressure behind a shock of 500 m/s, relative", _shock, "cells", (80, 40, 160), COMMON),
    "rotation": Tradeoff(
        "total energy after a turn, relative",
        _error_of("total energy", Rotation),
        "particles",
        (1000, 300, 3000),
        {**COMMON, **CELLS},
    ),
    "expansion": Tradeoff(
        "position after expanding, over R",
        _error_of("out: distance from r (1 + H t), over R", Expansion),
        "particles",
        (1000, 300),
        COMMON,
    ),
    "hydrostatic": Tradeoff(
        "RMS of P - P(r), over P(0)",
        _error_of("RMS of P - P(r), over P(0)", Hydrostatic),
        "particles",
        (2000, 500, 8000),
        {**COMMON, **CELLS, **GRAVITY, **SOUND},
    ),
    "collapse": Tradeoff(
        "collapse time, relative", _fall, "particles", (1000, 300, 4000), {**COMMON, **CELLS, **GRAVITY}
    ),
    "orbit": Tradeoff(
        "speed at contact [m/s]",
        _error_of("speed at contact", Infall),
        "particles",
        (500, 2000),
        {**COMMON, **GRAVITY, **SOUND},
    ),
    "rubble": Tradeoff(
        "angular momentum, relative",
        _error_of("angular momentum", Rubble),
        "particles",
        (300, 1000),
        {**COMMON, **CELLS},
    ),
    "bar": Tradeoff("peak stress at 10 /s, relative", _bar, "steps", (1000, 500, 2000, 4000), {}),
    "slope": Tradeoff("acceleration at 35 deg, relative", _layer, "cells", (16, 8, 32, 64), COMMON),
    "cliff": Tradeoff(
        "height at rest from Jutzi's SPH, RMS [L0]",
        _error_of("final: RMS of H from Jutzi's SPH", Cliff),
        "cells",
        (5, 10),
        COMMON,
    ),
}
