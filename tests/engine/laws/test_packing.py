"""Dilatancy of rubble towards a critical packing: the law alone, and drained shear at a constant pressure."""

import numpy as np
import pytest
import taichi as ti

from engine.laws.dissipation import Dissipation
from engine.laws.packing import AsDenseAsRock, CriticalState
from engine.scene.material import Material, named
from engine.scene.scene import Scene
from engine.simulation.simulation import Simulation
from engine.state.particles import Particles
from engine.verification.material_point import MaterialPoint
from tests.helpers.device import Array, evaluate
from tests.helpers.oracle import RHO0, G, K

pytestmark = pytest.mark.usefixtures("taichi")

PEAK, DILATANCY, DENSITY, CRUSHING = 0.945, 0.2, 2000.0, 1e7
LOOSENESS = RHO0 / DENSITY - 1.0
PACKING = {"dilatancy": DILATANCY, "critical_density": DENSITY}
RUBBLE = named("basalt", friction=PEAK, crushing_pressure=1e20, **PACKING)
CRUSHABLE = named("basalt", friction=PEAK, crushing_pressure=CRUSHING, **PACKING)


def packing_of(dilation: Array, material: Material = RUBBLE) -> CriticalState:
    particles = Particles(len(dilation))
    law = CriticalState(particles, [material])
    particles.write({"plastic_dilation": dilation})
    return law


def friction_at(dilation: Array, pressure: float, material: Material = RUBBLE) -> Array:
    count = len(dilation)
    numbers, bodies = np.arange(count, dtype=np.int32), np.zeros(count, dtype=np.int32)
    law = packing_of(dilation, material)
    return evaluate(law.friction, numbers, np.full(count, PEAK), np.full(count, pressure), bodies)[0]


def test_friction_falls_from_its_peak_by_the_dilatancy_that_is_left():
    dilation = np.array([0.0, 0.5 * LOOSENESS, LOOSENESS])
    np.testing.assert_allclose(friction_at(dilation, 1e5), PEAK - DILATANCY * np.array([0.0, 0.5, 1.0]), rtol=1e-14)


def test_rubble_looser_than_critical_has_less_friction_than_critical():
    """Under the crushing pressure the critical packing has half of the pores."""
    found = friction_at(np.array([0.0, 0.5 * LOOSENESS, LOOSENESS]), CRUSHING, CRUSHABLE)
    np.testing.assert_allclose(found, PEAK - DILATANCY * np.array([0.5, 1.0, 1.5]), rtol=1e-14)


def sheared(
    shear: float, steps: int, *, D: float = 1.0, J: float = 1.0, start: float = 0.0, Y: float = CRUSHING
) -> float:
    """Dilation after plastic shear at the crushing pressure, in equal steps."""
    law, number = packing_of(np.array([start]), CRUSHABLE), np.zeros(1, dtype=np.int32)

    @ti.func
    def shear_once(p, part):
        law.shear(p, part, J, CRUSHING, Y, D, 0)
        return law.dilation(p)

    for _ in range(steps):
        evaluate(shear_once, number, np.full(1, shear / steps))
    return float(law.plastic_dilation.to_numpy()[0])


@pytest.mark.parametrize(("D", "start"), [(1.0, 0.0), (0.4, 0.0), (1.0, LOOSENESS)])
def test_shear_moves_the_packing_towards_the_critical_one_whatever_its_steps(D, start):
    """Also denser, under a pressure that crushes: exponentially with shear, dJ_c/dgamma = dilatancy at first."""
    critical = 0.5 * LOOSENESS
    expected = critical + (start - critical) * np.exp(-DILATANCY / LOOSENESS * D * 2.0)
    found = [sheared(2.0, steps, D=D, start=start) for steps in (1, 5)]
    np.testing.assert_allclose(found, expected, rtol=1e-13)


def test_dilatancy_takes_no_more_than_the_work_of_shear():
    """Molten rock does not dilate, rock whose strength is half of the work of dilatancy half as much."""
    assert sheared(2.0, 3, Y=0.0) == 0.0
    assert sheared(2.0, 3, Y=0.5 * DILATANCY * CRUSHING) == pytest.approx(sheared(1.0, 3), rel=1e-13)


def test_matter_dilated_beyond_the_critical_density_has_lost_its_packing():
    assert sheared(0.0, 1, J=1.01 + LOOSENESS) == pytest.approx(LOOSENESS, rel=1e-15)
    assert sheared(0.0, 1, J=0.99 + LOOSENESS) == 0.0
    assert sheared(0.0, 1, J=1.01 + LOOSENESS, D=0.5) == 0.0, "rock that is not broken has none to lose"


def drained(material: Material, pressure: float, shear: float, steps: int) -> list[dict[str, float]]:
    """States of broken rock in simple shear, its volume controlled so that the pressure stays."""
    point = MaterialPoint(1, material, strength=True)
    point.constitution.dissipation = Dissipation(point.particles, False, True, False)
    point.particles.write({"damage_root": np.ones(1)})
    gradient, states, dilation = np.zeros((3, 3)), [], 0.0
    gradient[0, 1] = shear / steps
    for step in range(steps + 20):
        before, dilation = dilation, float(point["plastic_dilation"][0])
        growth = dilation - before + (float(point.pressure[0]) - pressure) / K
        point.step(growth / 3.0 * np.eye(3) + (step >= 20) * gradient, 1.0)
        s, J = point.deviator[0], float(point.J[0])
        stored = float(s.ravel() @ s.ravel()) / (4.0 * G) * J + 0.5 * float(point.pressure[0]) ** 2 / K
        states.append(
            {
                "J": J,
                "ratio": float(np.sqrt(0.5 * (s**2).sum()) / point.pressure[0]),
                "pressure": float(point.pressure[0]),
                "heat": RHO0 * float(point["E"][0]) - stored,
                "plastic": RHO0 * float(point["plastic_heat"][0]),
            }
        )
    return states[20:]


def test_drained_shear_goes_from_peak_to_critical_and_loosens():
    """J = 1 + L (1 - exp(-b gamma/L)), sqrt(J2)/P = mu - b (1 - exp(-b gamma/L)) of a circular cone."""
    states = drained(RUBBLE, 1e6, 6.0, 3000)
    gamma = np.linspace(0.0, 6.0, 3001)[1:]
    left = np.exp(-DILATANCY / LOOSENESS * gamma)
    J, ratio = (np.array([state[name] for state in states]) for name in ("J", "ratio"))
    pressures = np.array([state["pressure"] for state in states])
    assert (pressures > 1e5).all() and (pressures < 2e6).all(), "the control follows by one step"
    np.testing.assert_allclose(J, 1.0 + LOOSENESS * (1.0 - left), atol=2e-3)
    np.testing.assert_allclose(ratio[5:], PEAK - DILATANCY * (1.0 - left[5:]), rtol=2e-3)
    assert left[-1] < 0.04


@pytest.mark.parametrize("material", [RUBBLE, CRUSHABLE])
def test_shear_never_gives_work_back(material):
    """Friction does more work than dilatancy takes; the rest is counted as plastic heat."""
    states = drained(material, 1e7, 2.0, 1000)
    heat = np.array([state["heat"] for state in states])
    assert states[-1]["plastic"] == pytest.approx(heat[-1], rel=0.02)
    assert (np.diff(heat) >= -1e-3 * heat[-1] / 1000).all() and heat[-1] > 0.5 * (PEAK - DILATANCY) * 1e7 * 2.0


def test_loose_rubble_bears_pressure_below_its_own_density_alone():
    point = MaterialPoint(2, RUBBLE, strength=True)
    point.particles.write({"damage_root": np.ones(2), "plastic_dilation": np.array([LOOSENESS, 0.0])})
    point.step(((1.0 + LOOSENESS) * 0.999) ** (1.0 / 3.0) * np.eye(3) - np.eye(3), 1.0)
    assert point.pressure[0] == pytest.approx(1e-3 * K, rel=0.01) and point.pressure[1] == 0.0


@pytest.mark.parametrize("dilation", [0.0, LOOSENESS])
def test_the_signal_speed_is_at_least_that_of_the_tangent(dilation):
    """d(J P)/dJ of two small steps, over rho0: loose rubble is stiffer per mass."""
    particles = []
    for J in (0.9995, 0.9994):
        point = MaterialPoint(1, RUBBLE, shear=False)
        point.particles.write({"damage_root": np.ones(1), "plastic_dilation": np.full(1, dilation)})
        point.step((((1.0 + dilation) * J) ** (1.0 / 3.0) - 1.0) * np.eye(3), 1.0)
        particles.append((float(point.J[0]), float(point.J[0] * point.pressure[0]), float(point.signal_speed[0])))
    (J1, tau1, speed), (J2, tau2, _) = particles
    exact = (1.0 + dilation) * (tau2 - tau1) / (J1 - J2) / RHO0
    assert exact <= speed**2 / 3.0 * (1.0 + 1e-3) <= (1.0 + dilation) * exact * 1.01


def collision(**constants: float) -> Scene:
    body = {"radius": 5e4, "particles": 30, "damage": 1.0, "material": named("basalt", friction=0.9, **constants)}
    other = {**body, "position": (0.0, 1.05e5, 0.0), "velocity": (60.0, -200.0, 0.0)}
    return Scene.model_validate({"bodies": [body, other], "end_time": 400.0, "physics": {"fracture": None}})


def test_a_scene_without_a_critical_density_has_no_packing():
    assert isinstance(Simulation(collision()).constitution.packing, AsDenseAsRock)
    assert "plastic_dilation" not in Simulation(collision()).particles.allocated


def test_a_collision_loosens_and_keeps_its_energy():
    simulation = Simulation(collision(crushing_pressure=CRUSHING, **PACKING))
    simulation.start()
    before = simulation.totals()
    while not simulation.finished:
        simulation.advance(simulation.scene.end_time)
    dilation = simulation.particles.read("plastic_dilation")["plastic_dilation"]
    assert dilation.max() > 1e-3 and dilation.min() >= 0.0 and dilation.max() <= LOOSENESS
    assert simulation.totals().total_energy == pytest.approx(before.total_energy, rel=0.02)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"dilatancy": 0.1}, "give all or none"),
        ({"critical_density": 2000.0, "dilatancy": 0.1}, "absent: crushing_pressure"),
        ({**PACKING, "crushing_pressure": 1e7, "critical_density": 2700.0}, "must be below 'rho0'"),
        ({**PACKING, "crushing_pressure": 1e7, "critical_density": 1000.0}, "at least half"),
        ({**PACKING, "crushing_pressure": 1e7, "dilatancy": 0.5}, "at most half of 'friction'"),
    ],
)
def test_a_packing_that_cannot_be_is_refused(given, told):
    with pytest.raises(ValueError, match=told):
        named("basalt", friction=0.9, **given)
