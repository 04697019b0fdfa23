"""An infinite slope without cohesion (engine/physics.md, sections 4 and 11)."""

from dataclasses import dataclass
from math import inf

import numpy as np

from engine.scene.bodies import Box
from engine.scene.scene import Numerics, Physics, Scene, Wall
from engine.simulation.initial_conditions import initial_state
from engine.verification.check import Check
from engine.verification.harness import Array, Harness
from engine.verification.problems.materials import elastic

GRAVITY = 9.81
DEPTH = 1.0
DENSITY = 2000.0

DAMPING = 42.0
"""dx^4/(kappa dt) of the transfer (engine/physics.md, section 1)."""

SPREAD = 1.41
"""Displacement thickness over l = (kappa t)^(1/4), where damping alone spreads the drag of the base.

v = a t f(s), s = z/l: d4f/ds4 = 1 - f + s f'/4, f = f' = 0 at the base, and f = 1, f' = f'' = 0 at the plug, s = 3.91.
"""

ORDER = 0.75
"""In dx, of an error proportional to l: time steps shrink with dx."""


@dataclass(frozen=True)
class Layer:
    """A layer of rubble on a sticky base, periodic along and across the slope.

    Attributes:
        angle: inclination [rad].
        friction: coefficient mu_d [-].
        cells: depth in cells, a multiple of four.
        stiffness: c_l in units of sqrt(g H).
        end_time: in units of sqrt(H/g).
    """

    angle: float
    friction: float
    cells: int
    stiffness: float = 20.0
    end_time: float = 1.0

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
        material = elastic(DENSITY, 5.0 / 3.0 * self.shear_modulus, self.shear_modulus, self.friction)
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
        return Slide(acceleration, lag, simulation.step)


@dataclass(frozen=True)
class Slide:
    """Motion of a sliding layer.

    Attributes:
        acceleration: of the plug [m/s^2].
        lag: displacement thickness of the sheared layer below it [m], the integral of 1 - v/v_plug over z.
        steps: time steps done.
    """

    acceleration: float
    lag: float
    steps: int


@dataclass(frozen=True)
class Slope:
    """Above the friction angle a slope slides as a block on a plane does; below it rests.

    Friction grows with depth as weight does, so all depths yield at once, and only the transfer's damping of short
    waves decides how deep the layer shears: dv/dt = a - kappa d4v/dz4, kappa = dx^4/(42 dt) (engine/physics.md,
    section 1). It spreads the jump of velocity at the base over l = (kappa t)^(1/4), proportional to dx^(3/4)
    t^(1/4), and what the sheared part lags the plug gains. Another 1 % of the acceleration is the law's own: elastic
    shear strain raises the normal stress over P by mu^2 P/G. Measurements are in engine/verification/granular.md.

    The layer starts in balance, so the exact solution is valid from the start. It is measured over several passes of a
    shear wave, sqrt(3)/c_l each, while the plug is thicker than what shears below it.

    Attributes:
        friction_angle: of the rubble [deg].
        steep, gentle: inclinations [deg].
        cells: two depths in cells, the second twice the first.
    """

    name = "slope"
    friction_angle: float = 30.0
    steep: float = 35.0
    gentle: float = 25.0
    cells: tuple[int, int] = (32, 64)

    def checks(self, harness: Harness) -> list[Check]:
        """Compare the acceleration above the friction angle, measured and extrapolated to dx = 0, and rest below it."""
        friction = float(np.tan(np.deg2rad(self.friction_angle)))
        coarse, fine = (Layer(float(np.deg2rad(self.steep)), friction, cells) for cells in self.cells)
        rest = Layer(float(np.deg2rad(self.gentle)), friction, self.cells[0]).slide(harness).acceleration
        exact, slide, slow = fine.acceleration, fine.slide(harness), coarse.slide(harness).acceleration
        limit = slide.acceleration - (slow - slide.acceleration) / (2.0**ORDER - 1.0)
        effective = (fine.pull - slide.acceleration) / (GRAVITY * float(np.cos(fine.angle)))
        thickness = SPREAD * fine.scene.dx * (slide.steps / DAMPING) ** 0.25
        return [
            Check.relative(f"acceleration at {self.steep:.0f} deg", "m/s2", slide.acceleration, exact, 0.02),
            Check.relative("the same, extrapolated with order 3/4", "m/s2", limit, exact, 0.01),
            Check.relative("effective friction", "-", effective, friction, inf),
            Check.relative("displacement thickness of what shears", "m", slide.lag, thickness, inf),
            Check.absolute(f"acceleration at {self.gentle:.0f} deg", "m/s2", rest, 0.0, 1e-3 * GRAVITY),
        ]
