"""The state that is timed: two bodies deep in contact, with all physics of a collision but gravity."""

from engine.collision import Collision
from engine.scene import Gravity, Scene
from engine.simulation import Simulation


def collision(particles: int, gravity: Gravity | None = None) -> Scene:
    """A (200 m/s, 15 deg) collision of two bodies of `particles` each, from shortly before contact."""
    return Collision(
        velocity=200.0, angle=15.0, particles=particles, gravity=gravity, start_separation=1.05, end_time=1e5
    ).scene()


def in_contact(scene: Scene, time: float) -> Simulation:
    """The scene at a simulated time [s] after point-mass contact, free to step on."""
    simulation = Simulation(scene)
    simulation.start()
    while simulation.time < time:
        simulation.advance(time)
    simulation.clock.pause_time[None] = scene.end_time
    return simulation


def make_ready(simulation: Simulation) -> bool:
    """Let the next step run; returns whether particles had to be sorted into new blocks for it."""
    moved_out = bool(simulation.clock.moved_out[None])
    if moved_out:
        simulation.rebuild_blocks()
    return moved_out


def take_step(simulation: Simulation) -> float:
    """One time step, whatever it needs; returns its length [s]."""
    make_ready(simulation)
    simulation.transfer.step()
    return float(simulation.clock.dt[None])
