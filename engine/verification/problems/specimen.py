"""Particles that follow a prescribed deformation, without a grid."""

import numpy as np
import taichi as ti

from engine.device.backend import Real, mat3
from engine.laws.constitution import Constitution
from engine.laws.damage import Damage
from engine.laws.energy import InternalEnergy
from engine.laws.flaws import Flaws
from engine.laws.fracture import Fracture
from engine.laws.shear import Hencky
from engine.laws.strength import Strength
from engine.laws.tillotson import Tillotson
from engine.laws.viscosity import Inviscid
from engine.scene.bodies import Sphere
from engine.scene.material import FractureRules
from engine.state.particles import Particles


@ti.data_oriented
class Specimen:
    """All particles of one body under the same velocity gradient, with every law of rock.

    Args:
        body: sets material, spacing and number of particles.
        rule: rules of fracture.
        flaws: flaws of the particles.
    """

    def __init__(self, body: Sphere, rule: FractureRules, flaws: Flaws) -> None:
        self.particles = Particles(body.count)
        rock = [body.material]
        self.constitution = Constitution(
            self.particles,
            Tillotson(rock),
            InternalEnergy(self.particles),
            Hencky(self.particles, Strength(rock), rock),
            Damage(self.particles, Fracture([body], rule, flaws)),
            Inviscid(),
            rock,
        )

    def stretch(self, rate: float, dt: float) -> float:
        """Mean axial stress [Pa] after a step of length dt [s] at a strain rate [1/s] along x."""
        self._update(rate, dt)
        state = self.particles.read("tau", "j")
        return float(np.mean(state["tau"][:, 0] / (1.0 + state["j"])))

    @ti.kernel
    def _update(self, rate: ti.f64, dt: ti.f64):
        for p in range(self.particles.count):
            self.constitution.update(p, mat3(rate, 0, 0, 0, 0, 0, 0, 0, 0), ti.cast(dt, Real))
