"""What each verification scene can trade for time: its resolution and its settings, and the error they lead to."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.scene.material import named
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

CFL = {"numerics.cfl": (0.1, 0.25, 0.5, 0.9)}
PRECISION = {"numerics.precision": ("f64", "f32")}
COMMON = CFL | PRECISION
CELLS = {"numerics.particles_per_cell": (2.0, 4.0, 8.0)}
GRAVITY = {"physics.gravity.interval": (5.0, 10.0, 20.0, 40.0, 80.0), "physics.gravity.opening": (0.2, 0.5, 0.8)}
SOUND = {"physics.sound_speed": (1.0, 0.5, 0.25)}


@dataclass(frozen=True)
class Tradeoff:
    """One scene, its error as a function of resolution, and the knobs to turn.

    Attributes:
        quantity: what the error is of, and in which unit.
        error: its size at a resolution.
        resolution: what resolution counts: `particles`, `cells` or `steps`.
        values: resolutions, of which the first is used while another knob is turned.
        knobs: values of the scene by dotted key.
    """

    quantity: str
    error: Callable[[int], float]
    resolution: str
    values: tuple[int, ...]
    knobs: dict[str, tuple[Any, ...]]

    @property
    def runs(self) -> list[tuple[str, Any]]:
        """Knob and value of every run."""
        pairs = [(self.resolution, value) for value in self.values]
        return pairs + [(knob, value) for knob, values in self.knobs.items() for value in values]


def _share(found: float, exact: float) -> float:
    return abs(found / exact - 1.0)


def _wave(cells: int) -> float:
    return _share(StandingWave(cells).speed, named("basalt").longitudinal_speed)


def _fall(particles: int) -> float:
    fall = Fall(particles)
    return _share(fall.measure(), fall.collapse_time)


def _shock(cells: int) -> float:
    return _share(Impact(500.0, cells).measure()["P"], float(Shock(500.0).P))


def _layer(cells: int) -> float:
    layer = Layer(float(np.deg2rad(35.0)), float(np.tan(np.deg2rad(30.0))), cells)
    return _share(layer.slide().acceleration, layer.acceleration)


def _bar(steps: int) -> float:
    exact = Pull(10.0, steps=FINE_STEPS).reference().max()
    return _share(float(Pull(10.0, steps=steps).engine().max()), float(exact))


def _checked(problem: Any, quantity: str) -> float:
    return float(next(check.error for check in problem.checks() if check.quantity == quantity))


TRADEOFFS = {
    "column": Tradeoff("speed of a wave, relative", _wave, "cells", (16, 8, 32, 64), COMMON),
    "hugoniot": Tradeoff("pressure behind a shock of 500 m/s, relative", _shock, "cells", (80, 40, 160), COMMON),
    "rotation": Tradeoff(
        "total energy after a turn, relative",
        lambda particles: _checked(Rotation(particles), "total energy"),
        "particles",
        (1000, 300, 3000),
        COMMON | CELLS,
    ),
    "expansion": Tradeoff(
        "position after expanding, over R",
        lambda particles: _checked(Expansion(particles), "out: distance from r (1 + H t), over R"),
        "particles",
        (1000, 300),
        COMMON,
    ),
    "hydrostatic": Tradeoff(
        "RMS of P - P(r), over P(0)",
        lambda particles: _checked(Hydrostatic(particles), "RMS of P - P(r), as a share of P(0)"),
        "particles",
        (2000, 500, 8000),
        COMMON | CELLS | GRAVITY | SOUND,
    ),
    "collapse": Tradeoff("collapse time, relative", _fall, "particles", (1000, 300, 4000), COMMON | CELLS | GRAVITY),
    "orbit": Tradeoff(
        "speed at contact [m/s]",
        lambda particles: _checked(Infall(particles), "speed at contact"),
        "particles",
        (500, 2000),
        COMMON | GRAVITY | SOUND,
    ),
    "rubble": Tradeoff(
        "angular momentum, relative",
        lambda particles: _checked(Rubble(particles), "angular momentum"),
        "particles",
        (300, 1000),
        COMMON | CELLS,
    ),
    "bar": Tradeoff("peak stress at 10 /s, relative", _bar, "steps", (1000, 500, 2000, 4000), {}),
    "slope": Tradeoff("acceleration at 35 deg, relative", _layer, "cells", (16, 8, 32, 64), COMMON),
    "cliff": Tradeoff(
        "height at rest from Jutzi's SPH, RMS [L0]",
        lambda cells: _checked(Cliff(cells), "final: RMS of H from Jutzi's SPH"),
        "cells",
        (5, 10),
        COMMON,
    ),
}
