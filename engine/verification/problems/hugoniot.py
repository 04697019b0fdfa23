"""Shock waves (engine/physics.md, sections 2 and 6)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from engine.scene.bodies import Box
from engine.scene.material import Material, named
from engine.scene.murnaghan import MurnaghanParameters
from engine.scene.scene import Numerics, Physics, Scene, ViscosityCoefficients
from engine.verification.check import Check
from engine.verification.harness import Harness, State

BASALT = named("basalt")
MURNAGHAN = named("basalt", eos=MurnaghanParameters(K=2.67e10, n=4.0))

PLATEAU = (0.3, 0.8)
"""Where the state behind the front is measured, over its distance: off the heated plane and the front itself."""


@dataclass(frozen=True)
class Shock:
    """The exact state behind a shock in matter at rest without pressure, from the jump conditions.

    Attributes:
        up: particle velocity behind the front [m/s].
        material: matter, of which only density and equation of state count.
    """

    up: float
    material: Material = BASALT

    @property
    def c0(self) -> float:
        """Speed of sound [m/s] ahead of the front."""
        return float((self.material.eos.bulk_modulus() / self.material.rho0) ** 0.5)

    @cached_property
    def Us(self) -> float:
        """Shock speed [m/s]: the root of rho0 Us up = P(rho0 Us/(Us - up), up^2/2)."""
        rho0, eos = self.material.rho0, self.material.eos

        def excess(Us: float) -> float:
            return rho0 * Us * self.up - float(eos.pressure(rho0, self.up / (Us - self.up), self.E))

        return float(brentq(excess, self.up + 0.5 * self.c0, 10.0 * (self.up + self.c0), xtol=1e-9))

    @property
    def E(self) -> float:
        """Specific internal energy [J/kg]."""
        return 0.5 * self.up**2

    @property
    def P(self) -> float:
        """Pressure [Pa]."""
        return self.material.rho0 * self.Us * self.up

    @property
    def compression(self) -> float:
        """rho/rho0 - 1 [-]."""
        return self.up / (self.Us - self.up)

    @property
    def weak(self) -> bool:
        """Whether it runs at nearly the speed of sound, so that only Us - c0 tells it from a wave."""
        return self.up < 0.05 * self.c0


@dataclass(frozen=True)
class Impact:
    """Two strengthless slabs meet at 2 up; periodic across.

    Attributes:
        up: half their relative speed [m/s].
        cells: thickness of one slab in cells, a multiple of four.
        dx: grid spacing [m]; the problem has no scale but this one.
        material: of both slabs.
    """

    up: float
    cells: int = 80
    dx: float = 1.0
    material: Material = BASALT

    @property
    def across(self) -> int:
        """Particles across four cells.

        A lattice with one a cell has the exact speed of sound, which Us - c0 needs; where matter is compressed more,
        it is not stable (engine/physics.md, section 1).
        """
        return 4 if Shock(self.up, self.material).weak else 5

    @property
    def scene(self) -> Scene:
        """Both slabs, until the front has passed nine tenths of them."""
        across, along = 4.0 * self.dx, 8 if self.across == 4 else 5
        slabs = tuple(
            Box(
                size=(self.cells * self.dx, across, across),
                lattice=(along * self.cells // 4, self.across, self.across),
                position=(-0.5 * toward * self.cells * self.dx, 0.5 * across, 0.5 * across),
                velocity=(toward * self.up, 0.0, 0.0),
                material=self.material,
            )
            for toward in (1, -1)
        )
        shock = ViscosityCoefficients(shock_linear=0.5, shock_quadratic=1.5)
        return Scene(
            bodies=slabs,
            period=(None, across, across),
            end_time=0.9 * self.cells * self.dx / Shock(self.up, self.material).Us,
            physics=Physics(shear=False, strength=False, fracture=None, gravity=None, contact=None, viscosity=shock),
            numerics=Numerics(particles_per_cell=along * self.across**2 / 64.0),
        )

    def measure(self, harness: Harness) -> dict[str, float]:
        """Return Us [m/s], P [Pa], rho/rho0 - 1 (`compression`) [-] and E [J/kg] of a run."""
        scene = self.scene
        simulation = harness.start(scene)
        half, end = (harness.run_until(simulation, part * scene.end_time) for part in (0.5, 1.0))
        first, last = (_front(state, 2 * self.across**2) for state in (half, end))
        distance = np.abs(end.x[:, 0])
        plateau = (distance > PLATEAU[0] * last) & (distance < PLATEAU[1] * last)
        return {
            "Us": self.up + (last - first) / (end.time - half.time),
            "P": float(end.P[plateau].mean()),
            "compression": float((1.0 / end.J[plateau]).mean() - 1.0),
            "E": float(end.fields["E"][plateau].mean()),
        }


@dataclass(frozen=True)
class Hugoniot:
    """States behind shocks against the exact Hugoniot.

    Attributes:
        speeds: particle velocities [m/s].
        cells: thickness of one slab in cells; a front forms over some c0/up of them.
        material: of the slabs.
        name: of the problem in the catalogue.
    """

    speeds: tuple[float, ...] = (100.0, 500.0, 2000.0)
    cells: int = 80
    material: Material = BASALT
    name: str = "hugoniot"

    def checks(self, harness: Harness) -> list[Check]:
        """Compare Us - c0 of weak shocks within 10 %; of strong ones Us, P, rho/rho0 - 1 within 2 %, E within 5 %."""
        shocks = [Shock(up, self.material) for up in self.speeds]
        runs = [Impact(up, self.cells, material=self.material).measure(harness) for up in self.speeds]
        return [check for shock, run in zip(shocks, runs, strict=True) for check in _compare(shock, run)]


def _compare(exact: Shock, measured: dict[str, float]) -> list[Check]:
    at = f"{exact.up:.0f} m/s: "
    if exact.weak:
        return [Check.relative(at + "Us - c0", "m/s", measured["Us"] - exact.c0, exact.Us - exact.c0, 0.10)]
    return [
        Check.relative(at + "Us", "m/s", measured["Us"], exact.Us, 0.02),
        Check.relative(at + "P", "Pa", measured["P"], exact.P, 0.02),
        Check.relative(at + "rho/rho0 - 1", "-", measured["compression"], exact.compression, 0.02),
        Check.relative(at + "E", "J/kg", measured["E"], exact.E, 0.05),
    ]


def _front(state: State, pair: int) -> float:
    """Distance [m] of the fronts from the plane of impact: where P falls through half its plateau.

    Args:
        state: of both slabs.
        pair: particles of a pair of layers, one on either side of the plane.
    """
    distance = np.abs(state.x[:, 0])
    order = np.argsort(distance, kind="stable")
    r, P = (values[order].reshape(-1, pair).mean(axis=1) for values in (distance, state.P))
    level = 0.5 * float(np.median(P[0.5 * P.max() < P]))
    last = int(np.flatnonzero(level < P)[-1])
    return float(np.interp(level, [P[last + 1], P[last]], [r[last + 1], r[last]]))
