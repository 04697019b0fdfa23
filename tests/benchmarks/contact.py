"""The state that is timed: two bodies deep in contact, and steps from there on."""

from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation


def in_contact(scene: Scene, time: float) -> Simulation:
    """The scene at a simulated time [s] after point-mass contact, free to step on."""
    simulation = Simulation(scene)
    simulation.start()
    while simulation.time < time:
        simulation.advance(time)
    simulation.clock.pause_time[None] = scene.end_time
    return simulation


def continued(simulation: Simulation, scene: Scene) -> Simulation:
    """Another scene with the same particles, in the state of a simulation as far as its parts hold it."""
    result = Simulation(scene)
    now = simulation.clock_state()
    clock_state = {**result.clock_state(), "rate": now["rate"], "dt": now["dt"], "time": now["time"]}
    result.restore(simulation.particles.read(*result.particles.allocated), clock_state)
    result.clock.pause_time[None] = scene.end_time
    return result


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
