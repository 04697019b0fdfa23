"""Collapse of a granular cliff (engine/physics.md, sections 4 and 11; Jutzi 2015, figure 1)."""

from dataclasses import dataclass
from math import inf
from pathlib import Path

import numpy as np

from engine.scene.bodies import Box
from engine.scene.scene import Numerics, Physics, Scene, Wall
from engine.verification.check import Check
from engine.verification.harness import Array, Harness, State
from engine.verification.problems.materials import elastic

DATA = Path(__file__).parents[1] / "data"
GRAVITY, DENSITY, WIDTH = 9.81, 2000.0, 1.0
FRICTION = float(np.tan(np.deg2rad(20.9)))
THIN = 0.01
"""Height [L0] at which the front ends."""

REST = 8.0
"""When the flow has come to rest, in units of sqrt(H0/g)."""


@dataclass(frozen=True)
class Cliff:
    """A column of rubble between a smooth wall and a rough floor collapses; periodic across.

    Attributes:
        cells: cells along the initial width; 2 cells x aspect is whole.
        stiffness: c_l in units of sqrt(g H0).
        aspect: initial height over width; the published profiles are those of 3.2.
        filter_time: time of the transfer's filter [dx/(c_l + v_m)].
    """

    name = "cliff"
    cells: int = 10
    stiffness: float = 20.0
    aspect: float = 3.2
    filter_time: float = Numerics().filter_time

    @property
    def height(self) -> float:
        """Initial height H0 [m]."""
        return self.aspect * WIDTH

    @property
    def fall_time(self) -> float:
        """sqrt(H0/g) [s]."""
        return float(np.sqrt(self.height / GRAVITY))

    @property
    def scene(self) -> Scene:
        """The column with four particles a cell in the plane of the flow; half a cell of it lies in wall and floor."""
        dx = WIDTH / self.cells
        shear = DENSITY * self.stiffness**2 * GRAVITY * self.height / 3.0
        body = Box(
            size=(WIDTH, 4.0 * dx, self.height),
            lattice=(2 * self.cells, 4, round(2 * self.aspect * self.cells)),
            position=(0.5 * WIDTH - 0.5 * dx, 2.0 * dx, 0.5 * self.height - 0.5 * dx),
            material=elastic(DENSITY, 5.0 / 3.0 * shear, shear, FRICTION),
            damage=1.0,
        )
        walls = (Wall(normal=(1.0, 0.0, 0.0)), Wall(friction="stick"))
        return Scene(
            bodies=(body,),
            period=(None, 4.0 * dx, None),
            end_time=REST * self.fall_time,
            physics=Physics(fracture=None, gravity=None, uniform_gravity=(0.0, 0.0, -GRAVITY), walls=walls),
            numerics=Numerics(particles_per_cell=4.0, filter_time=self.filter_time),
        )

    def checks(self, harness: Harness) -> list[Check]:
        """Compare height and front, while it falls and at rest, with the experiments and Jutzi's SPH.

        Only the heights at rest can fail: fronts are single grains, and the codes and the experiments disagree at tau.
        """
        states = self.run(harness)
        motion = float(np.sqrt(np.mean(states["final"].speed ** 2)) / np.sqrt(GRAVITY * self.height))
        checks = [check for when, state in states.items() for check in self._compare(when, state)]
        return [*checks, Check.absolute("speed at rest, over sqrt(g H0)", "-", motion, 0.0, inf)]

    def run(self, harness: Harness) -> dict[str, State]:
        """Return the states at sqrt(H0/g), `tau`, and at rest, `final`."""
        simulation = harness.start(self.scene)
        ends = {"tau": self.fall_time, "final": self.scene.end_time}
        return {when: harness.run_until(simulation, end) for when, end in ends.items()}

    def _compare(self, when: str, state: State) -> list[Check]:
        L, H = self.profile(state)
        front = self.front(state)
        band, sph = experiment(when), jutzi(when)
        below, above = (np.interp(band[:, 0], L, H) - band[:, side] for side in (1, 2))
        outside = float(np.sqrt(np.mean(np.maximum(np.maximum(-below, above), 0.0) ** 2)))
        middle = float(np.sqrt(np.mean((np.interp(band[:, 0], L, H) - band[:, 1:].mean(axis=1)) ** 2)))
        beside = float(np.sqrt(np.mean((np.interp(sph[:, 0], L, H) - sph[:, 1]) ** 2)))
        allowed = 0.1 if when == "final" else inf
        return [
            Check.absolute(f"{when}: RMS of H outside the experiments", "L0", outside, 0.0, allowed),
            Check.absolute(f"{when}: RMS of H from their middle", "L0", middle, 0.0, inf),
            Check.absolute(f"{when}: RMS of H from Jutzi's SPH", "L0", beside, 0.0, allowed),
            Check.absolute(f"{when}: front", "L0", front, float(sph[sph[:, 1] > THIN, 0].max()), inf),
        ]

    def front(self, state: State) -> float:
        """Return the distance of the front from the wall [L0]."""
        L, H = self.profile(state)
        return float(L[H > THIN].max())

    def profile(self, state: State) -> tuple[Array, Array]:
        """Return distances from the wall and heights of the surface, both in L0, of strips of one cell.

        A strip's height is the area of rubble in it over dx: rubble that flies above the surface does not count twice.
        Particles spread their area over three strips as mass over nodes; whole columns of the initial lattice would
        change strip otherwise.
        """
        dx = WIDTH / self.cells
        position = state.x[:, 0] / dx + 0.5
        strip = np.floor(position)
        strips = (strip[:, None] + [-1.0, 0.0, 1.0]).astype(int)
        # the wall mirrors
        strips = np.where(strips < 0, -1 - strips, strips)
        area = state.J[:, None] * self.scene.bodies[0].spacing ** 3 / (4.0 * dx) * _spread(position - strip)
        H = np.bincount(strips.ravel(), weights=area.ravel()) / dx
        return np.asarray((np.arange(len(H)) + 0.5) * dx / WIDTH), np.asarray(H / WIDTH)


def _spread(f: Array) -> Array:
    """Quadratic B-spline weights of the strips before, around and after a particle, f in [0, 1) within its own."""
    return np.stack([0.5 * (1.0 - f) ** 2, 0.75 - (f - 0.5) ** 2, 0.5 * f**2], axis=1)


def experiment(when: str) -> Array:
    """Return distance, lowest and highest height of the experiments [L0], shape [point_count, 3].

    Source: Lajeunesse et al. 2005, as drawn in figure 1 of Jutzi 2015.
    """
    return np.loadtxt(DATA / f"lajeunesse2005_band_via_jutzi2015_{when}.csv", delimiter=",", skiprows=1)


def jutzi(when: str) -> Array:
    """Return distance and height of Jutzi's SPH at constant friction [L0], the upper envelope, shape [point_count, 2].

    Source: Jutzi 2015, figure 1.
    """
    outline = np.loadtxt(DATA / f"jutzi2015_fig1_DP_{when}.csv", delimiter=",", skiprows=1)
    distance = np.unique(outline[:, 0])
    return np.array([[L, outline[outline[:, 0] == L, 1].max()] for L in distance])
