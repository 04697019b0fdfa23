"""An infinite slope without cohesion (engine/physics.md, sections 4 and 11)."""

from dataclasses import dataclass
from math import inf

import numpy as np

from engine.scene.bodies import Box
from engine.scene.scene import Numerics, Physics, Scene, Wall
from engine.simulation.initial_conditions import initial_state
from engine.verification.check import Check
from engine.verification.harness import Array, Harness
from engine.verification.problems.friction_angle import in_compression, in_shear
from engine.verification.problems.materials import elastic

GRAVITY = 9.81
DEPTH = 1.0
DENSITY = 2000.0

ORDER = 0.875
"""In dx, of an error proportional to the depth over which the filter spreads the drag of the base."""


@dataclass(frozen=True)
class Layer:
    """A layer of rubble on a sticky base, periodic along and across the slope.

    Attributes:
        angle: inclination [rad].
        friction: coefficient sqrt(J2)/P in simple shear [-].
        cells: depth in cells, a multiple of four.
        stiffness: c_l in units of sqrt(g H).
        end_time: in units of sqrt(H/g).
        law: of friction.
        compression: coefficient in triaxial compression [-]; the same as in simple shear if it is not given.
    """

    angle: float
    friction: float
    cells: int
    stiffness: float = 20.0
    end_time: float = 1.0
    law: str = "drucker-prager"
    compression: float | None = None

    @property
    def acceleration(self) -> float:
        """Exact acceleration g (sin th - mu_d cos th), or rest [m/s^2]."""
        return GRAVITY * max(0.0, float(np.sin(self.angle) - self.friction * np.cos(self.angle)))

    @property
    def pull(self) -> float:
        """g sin th [m/s^2]."""
        return GRAVITY * float(np.sin(self.angle))

    @property
    def shear_modulus(self) -> float:
        """G [Pa] with K = 5G/3, so that rho c_l^2 = 3G."""
        return DENSITY * self.stiffness**2 * GRAVITY * DEPTH / 3.0

    @property
    def scene(self) -> Scene:
        """One particle a cell along and across the slope, two in depth; z is normal to it.

        The lowest half cell lies in the base: nodes above it then have matter on all sides.
        """
        dx = DEPTH / self.cells
        across = 4.0 * dx
        friction = self.friction if self.compression is None else self.compression
        material = elastic(DENSITY, 5.0 / 3.0 * self.shear_modulus, self.shear_modulus, friction, self.law)
        body = Box(
            size=(across, across, DEPTH),
            lattice=(4, 4, 2 * self.cells),
            position=(0.5 * across, 0.5 * across, 0.5 * DEPTH - 0.5 * dx),
            material=material,
            damage=1.0,
        )
        gravity = (self.pull, 0.0, -GRAVITY * float(np.cos(self.angle)))
        return Scene(
            bodies=(body,),
            period=(across, across, None),
            end_time=self.end_time * (DEPTH / GRAVITY) ** 0.5,
            physics=Physics(fracture=None, gravity=None, uniform_gravity=gravity, walls=(Wall(friction="stick"),)),
            numerics=Numerics(particles_per_cell=2.0),
        )

    def balance(self, z: Array) -> dict[str, Array]:
        """Return fields of the state in balance under the layer's weight, with a shear stress of at most mu_d P.

        Args:
            z: heights above the bottom [m], shape [particle_count].
        """
        weight = DENSITY * GRAVITY * (DEPTH - z)
        P = weight * np.cos(self.angle)
        shear = np.minimum(weight * np.sin(self.angle), self.friction * P)
        mu = P / (5.0 / 3.0 * self.shear_modulus)
        J, zero = 1.0 / (1.0 + mu), 0.0 * z
        strain = J * shear / self.shear_modulus
        wide = np.cosh(strain) - 1.0
        return {
            "j": -mu / (1.0 + mu),
            "b_minus_I": np.stack([wide, zero, wide, zero, np.sinh(strain), zero], axis=1),
            "tau": np.stack([-J * P, -J * P, -J * P, zero, J * shear, zero], axis=1),
        }

    def slide(self, harness: Harness) -> "Slide":
        """Run the layer; measure the motion of the plug, the upper half, during the second half of the time."""
        scene = self.scene
        z = initial_state(scene)["x"][:, 2] + 0.5 * scene.dx
        simulation, plug = harness.start(scene, **self.balance(z)), z > 0.5 * DEPTH
        states = [harness.run_until(simulation, time) for time in np.linspace(0.5, 1.0, 21) * scene.end_time]
        speeds = [float(state.v[plug, 0].mean()) for state in states]
        acceleration = float(np.polyfit([state.time for state in states], speeds, 1)[0])
        # the half cell in the wall belongs to the base
        lag = DEPTH * (1.0 - float(states[-1].v[:, 0].mean()) / speeds[-1]) - 0.5 * scene.dx
        return Slide(acceleration, lag)


@dataclass(frozen=True)
class Slide:
    """Motion of a sliding layer.

    Attributes:
        acceleration: of the plug [m/s^2].
        lag: displacement thickness of the sheared layer below it [m], the integral of 1 - v/v_plug over z.
    """

    acceleration: float
    lag: float


@dataclass(frozen=True)
class Slope:
    """Above the friction angle a slope slides as a block on a plane does; below it rests.

    Friction grows with depth as weight does, so all depths yield at once, and only the transfer's filter of short
    waves decides how deep the layer shears: dv/dt = a - kappa d8v/dz8, kappa = dx^8/(1764 t_f) (engine/physics.md,
    section 1). It spreads the jump of velocity at the base over l = (kappa t)^(1/8), proportional to dx^(7/8)
    t^(1/8), and what the sheared part lags the plug gains. Another 1 % of the acceleration is the law's own: elastic
    shear strain raises the normal stress over P by mu^2 P/G. Layers of 96 cells break up within the time (section 4 of
    engine/physics.md: friction without dilatancy is ill-posed). Measurements are in engine/verification/granular.md.

    The layer shears in plane strain, with a Lode parameter of zero: laws of friction that depend on it have the same
    slope, tan th = sqrt(J2)/P of pure shear, at another friction angle.

    The layer starts in balance, so the exact solution is valid from the start. It is measured over several passes of a
    shear wave, sqrt(3)/c_l each, while the plug is thicker than what shears below it.

    Attributes:
        friction_angle: of the law, or, with `drucker-prager`, of the slope itself [deg].
        steep, gentle: inclinations [deg].
        cells: two depths in cells, the second twice the first.
        law: of friction.
        name: of the problem in the catalogue.
    """

    friction_angle: float = 30.0
    steep: float = 35.0
    gentle: float = 25.0
    cells: tuple[int, int] = (32, 64)
    law: str = "drucker-prager"
    name: str = "slope"

    def layer(self, inclination: float, cells: int) -> Layer:
        """Return a layer of this rubble.

        Args:
            inclination: [deg].
            cells: its depth.
        """
        angle, phi = float(np.deg2rad(inclination)), float(np.deg2rad(self.friction_angle))
        if self.law == "drucker-prager":
            return Layer(angle, float(np.tan(phi)), cells)
        return Layer(angle, in_shear(self.law, phi), cells, law=self.law, compression=in_compression(phi))

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the acceleration above the friction angle, measured and extrapolated to dx = 0, and rest below it."""
        coarse, fine = (self.layer(self.steep, cells) for cells in self.cells)
        rest = self.layer(self.gentle, self.cells[0]).slide(harness).acceleration
        exact, slide, slow = fine.acceleration, fine.slide(harness), coarse.slide(harness).acceleration
        limit = slide.acceleration - (slow - slide.acceleration) / (2.0**ORDER - 1.0)
        effective = (fine.pull - slide.acceleration) / (GRAVITY * float(np.cos(fine.angle)))
        return [
            Check.relative(f"acceleration at {self.steep:.0f} deg", "m/s2", slide.acceleration, exact, 0.02),
            Check.relative("the same, extrapolated with order 7/8", "m/s2", limit, exact, 0.015),
            Check.relative("effective friction", "-", effective, fine.friction, inf),
            Check.absolute("displacement thickness of what shears", "cells", slide.lag / fine.scene.dx, 0.0, inf),
            Check.absolute(f"acceleration at {self.gentle:.0f} deg", "m/s2", rest, 0.0, 1e-3 * GRAVITY),
        ]
