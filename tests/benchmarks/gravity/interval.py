"""What a collision loses because gravity is held for an interval, and what the tree's net torque would do to it."""

from typing import Any

import numpy as np

from engine.device import backend
from engine.gravity.net_force import NetForce
from engine.gravity.self_gravity import SelfGravity
from engine.scene.collision import Collision
from engine.scene.scene import Gravity
from engine.simulation.simulation import Simulation
from tests.benchmarks.child import answer

PARTICLES, AFTER_CONTACT = 1000, 6000.0


def leave_uncorrected(gravity: SelfGravity) -> None:
    """Let the net force and torque be found and stay."""
    correct = gravity.rigid.apply

    def find() -> NetForce:
        removed = correct()
        gravity.acceleration.copy_from(gravity.pull)
        return removed

    gravity.rigid.apply = find


def measure(interval: float, corrected: bool) -> dict[str, Any]:
    """Drift of energy and angular momentum of a (100 m/s, 15 deg) collision; `corrected` as the engine does it."""
    backend.start(threads=1)
    gravity = Gravity(interval=interval)
    collision = Collision(velocity=100.0, angle=15.0, particles=PARTICLES, end_time=AFTER_CONTACT, gravity=gravity)
    simulation = Simulation(collision.scene())
    if not corrected:
        leave_uncorrected(simulation.gravity)
    simulation.start()
    begin, residuals = simulation.totals(), []
    while not simulation.finished:
        simulation.advance(simulation.time + interval)
        residuals.append((simulation.events.gravity_force, simulation.events.gravity_torque))
    end = simulation.totals()
    force, torque = np.mean(residuals, axis=0)
    lost = np.linalg.norm(end.angular_momentum - begin.angular_momentum) / np.linalg.norm(begin.angular_momentum)
    return {
        "interval": interval,
        "corrected": corrected,
        "steps": simulation.step,
        "energy": (end.total_energy - begin.total_energy) / begin.kinetic_energy,
        "angular_momentum": float(lost),
        "force": float(force),
        "torque": float(torque),
    }


if __name__ == "__main__":
    answer(measure)
