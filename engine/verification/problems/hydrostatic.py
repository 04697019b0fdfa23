"""A body at rest under its own gravity (engine/physics.md, sections 7 and 8)."""

from dataclasses import dataclass

import numpy as np

from engine.constants import G_NEWTON
from engine.scene.bodies import Sphere
from engine.scene.scene import Physics, Scene
from engine.verification.check import Check
from engine.verification.harness import Array, Harness


@dataclass(frozen=True)
class Hydrostatic:
    """One sphere, in balance from the start: it stays at rest, keeps its pressure, and does not break.

    Attributes:
        particles: number of particles.
        end_time: duration [s].
        seeds: of the arrangement of particles and of their flaws; the worst counts.
        sound_speed: factor on the speed of sound.
    """

    name = "hydrostatic"
    particles: int = 2000
    end_time: float = 600.0
    seeds: tuple[int, ...] = (0,)
    sound_speed: float = 1.0

    @property
    def body(self) -> Sphere:
        """The sphere."""
        return Sphere(radius=50e3, particles=self.particles)

    def pressure(self, r: Array) -> Array:
        """Return P(r) = (2/3) pi G rho^2 (R^2 - r^2) [Pa] at distances r [m] from the centre."""
        body = self.body
        return np.asarray(2.0 / 3.0 * np.pi * G_NEWTON * body.material.rho0**2 * (body.radius**2 - r**2))

    def at_rest(self, harness: Harness, seed: int) -> tuple[float, float, float]:
        """Return the RMS of P - P(r) [Pa], the RMS speed [m/s] and the fraction of broken particles at the end."""
        physics = Physics(sound_speed=self.sound_speed)
        scene = Scene(bodies=(self.body,), end_time=self.end_time, physics=physics, seed=seed)
        end = harness.run_until(harness.start(scene), self.end_time)
        r = np.linalg.norm(end.x - end.x.mean(axis=0), axis=1)
        deviation = np.sqrt(np.mean((end.P - self.pressure(r)) ** 2))
        return float(deviation), float(np.sqrt(np.mean(end.speed**2))), float(np.mean(end.damage > 0.0))

    def checks(self, harness: Harness) -> list[Check]:
        """Compare pressure, speed and damage at the end with those of a body at rest."""
        runs = [self.at_rest(harness, seed) for seed in self.seeds]
        deviation, motion, broken = map(max, zip(*runs, strict=True))
        centre = float(self.pressure(np.zeros(1))[0])
        return [
            Check.relative("RMS of P - P(r), over P(0)", "Pa", deviation, 0.0, 0.03, scale=centre),
            Check.absolute("speed, RMS", "m/s", motion, 0.0, 0.01),
            Check.absolute("fraction of broken particles", "-", broken, 0.0, 0.001),
        ]
