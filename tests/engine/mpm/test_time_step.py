import numpy as np
import pytest

from engine.device import backend
from engine.simulation.simulation import Simulation
from engine.verification.harness import altered
from tests.helpers.device import Array
from tests.helpers.oracle import RHO0, G, squared_sound_speed
from tests.helpers.scenes import RUBBLE, body, one_step, scene, spline, started

SIGNAL_SPEED = float(np.sqrt(3.0 * 2.67e10 / RHO0))


@pytest.mark.usefixtures("taichi")
def test_the_time_step_obeys_the_tightest_of_its_limits():
    given = scene(body())
    simulation, dx = started(given), given.dx
    x, reach = simulation.particles.read("x")["x"], given.numerics.cfl * dx
    gradient = np.tile(0.3 * np.eye(3), (100, 1, 1))
    limits = [
        ({}, reach / SIGNAL_SPEED),
        ({"v": np.tile([3000.0, 0.0, 4000.0], (100, 1))}, reach / (SIGNAL_SPEED + 5000.0)),
        ({"v": x @ gradient[0], "C": gradient}, 0.3 / (0.3 * np.sqrt(3.0))),
    ]
    for state, expected in limits:
        simulation.start(**state)
        one_step(simulation)
        # the state after one step: compression and speed have hardly changed
        assert 1.0 / simulation.clock.rate[None] == pytest.approx(expected, rel=1e-2)


@pytest.mark.usefixtures("taichi")
def test_strong_gravity_shortens_the_time_step():
    given = scene(body(), physics={**RUBBLE, "uniform_gravity": (0.0, -1e4, 0.0)})
    # at rest after the first kick, which is that of half a step
    first = given.numerics.cfl * given.dx / SIGNAL_SPEED
    simulation = started(given, v=np.tile([0.0, 0.5e4 * first, 0.0], (100, 1)))
    one_step(simulation)
    assert 1.0 / simulation.clock.rate[None] == pytest.approx(np.sqrt(given.dx / 1e4), rel=1e-2)


@pytest.mark.usefixtures("taichi")
def test_viscosity_and_the_courant_number_shorten_the_time_step():
    viscous = {"fracture": None, "gravity": None, "viscosity": {"shear": 1e9, "bulk": 2e9}}
    given = scene(body(), physics=viscous, numerics={"cfl": 0.2})
    simulation = started(given)
    assert one_step(simulation) == pytest.approx(0.2 * given.dx / SIGNAL_SPEED, rel=1e-4)
    wave, diffusion = SIGNAL_SPEED / (0.2 * given.dx), 6.0 * 3e9 / given.dx**2
    assert simulation.clock.rate[None] == pytest.approx(wave + diffusion, rel=1e-4)


@pytest.mark.usefixtures("taichi")
def test_stress_inside_matter_shortens_the_time_step_too():
    """Matter that is everywhere at the same high pressure does not move, and yet could."""
    cells = {"size": (4.0, 4.0, 4.0), "lattice": (8, 8, 8), "position": (2.0, 2.0, 2.0)}
    given = scene(cells, period=(4.0, 4.0, 4.0), numerics={"particles_per_cell": 8.0, "cfl": 1.0})
    simulation = started(given, j=np.full(512, -0.5))
    one_step(simulation)
    state = simulation.particles.read("tau", "C")
    assert np.abs(state["C"]).max() < 1e-6
    norm = np.sqrt(3.0) * np.abs(state["tau"][0, 0])
    assert 1.0 / simulation.clock.rate[None] == pytest.approx(np.sqrt(0.3 * RHO0 / (4.0 * norm)), rel=1e-9)


def test_a_scene_begins_with_the_step_it_says():
    """Also where fast rotation, not sound, limits it."""
    for spin in (0.0, 10.0):
        backend.start(threads=1)
        simulation = started(scene(body(spin=(0.0, 0.0, spin))))
        assert one_step(simulation) == simulation.first_dt
    assert simulation.first_dt == pytest.approx(0.3 / (np.sqrt(2.0) * 10.0), rel=1e-12)


@pytest.fixture(scope="module")
def ballistic() -> Simulation:
    """One particle that flies at 500 m/s, to be started in any state; the tests that use it stand together."""
    backend.start(threads=1)
    return Simulation(scene(body(particles=1, velocity=(0.0, 300.0, 400.0))))


@pytest.mark.parametrize("stress", [[1e11, 0.0, 0.0, 0.0, 0.0, 0.0], [-4e10, 2e10, 0.0, 3e10, 4e10, -5e10]])
def test_stress_that_nothing_holds_shortens_the_first_and_all_further_time_steps(ballistic, stress):
    """It must not deform the particle by more than 0.3: 4 dt^2 |tau| / (rho0 dx^2), also when others come near.

    In the first step by 0.003, and steps then grow by a quarter.
    """
    norm = np.sqrt(np.sum(np.square(stress) * [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]))
    ballistic.start(tau=np.array([stress]))
    expected = ballistic.scene.dx * np.sqrt(0.3 * RHO0 / (4.0 * norm))
    for n in range(14):
        assert one_step(ballistic) == pytest.approx(expected * min(0.1 * 1.25**n, 1.0), rel=1e-12)


@pytest.mark.parametrize(("j", "E"), [(0.0, 0.0), (-0.4, 0.0), (0.2, 3e7), (-0.3, 1e8)])
def test_a_lonely_particle_counts_with_the_sound_speed_of_its_state(ballistic, j, E):
    ballistic.start(j=np.array([j]), E=np.array([E]))
    one_step(ballistic)
    c2 = squared_sound_speed(np.array([1.0 / (1.0 + j) - 1.0]), np.array([E]))[0]
    speed = np.sqrt(max(3.0 * c2, 2.0 * G / RHO0)) + 500.0
    reach = ballistic.scene.numerics.cfl * ballistic.scene.dx
    assert 1.0 / ballistic.clock.rate[None] == pytest.approx(reach / speed, rel=1e-9)


def breathing(cfl: float, shear: bool, spread: float, viscosity: float = 0.0) -> float:
    """Growth of a small random deformation of eight particles in 400 time steps; they lie within `spread` cells."""
    physics: dict[str, object] = {"shear": shear, "strength": False, "fracture": None, "gravity": None}
    physics |= {"viscosity": {"bulk": viscosity}} if viscosity else {}
    given = altered(scene(body(particles=8, damage=0.0), physics=physics), "numerics.cfl", cfl)
    generator, simulation = np.random.default_rng(1), Simulation(given)
    x = given.dx * spread * generator.uniform(-0.5, 0.5, (8, 3))
    simulation.start(x=x, C=1e-9 * generator.normal(size=(8, 3, 3)), v=np.zeros((8, 3)))
    while simulation.step < 400:
        simulation.advance(given.end_time)
    return float(np.abs(simulation.particles.read("j")["j"]).max()) / (1e-9 * given.dx / SIGNAL_SPEED)


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("shear", [True, False])
def test_particles_are_stable_however_they_lie(shear):
    """A cluster that is small against a cell breathes at the highest frequency there is, 2 c/dx."""
    assert all(breathing(0.98, shear, spread) < 10.0 for spread in (0.01, 1.0, 3.0))
    assert breathing(1.02, shear, 0.01) > 1e6


@pytest.mark.usefixtures("taichi")
def test_particles_with_viscosity_are_stable_however_they_lie():
    """The viscosity at which waves and diffusion alone allow the same step; then their rates add."""
    dx = scene(body(particles=8)).dx
    viscosity = SIGNAL_SPEED * dx / 6.0
    assert all(breathing(0.98, True, spread, viscosity) < 10.0 for spread in (0.01, 1.0, 3.0))


@pytest.mark.parametrize("moduli", [(1.0, 0.0), (26.7, 22.7), (0.01, 1.0)])
@pytest.mark.parametrize("spread", [0.01, 1.5, 3.0])
def test_no_arrangement_of_particles_oscillates_faster(moduli, spread):
    """Largest eigenvalue of the stiffness of clouds, over 4 max(3 K, 2 G)/(rho0 dx^2)."""
    K, G = moduli
    generator = np.random.default_rng(1)
    bound = 4.0 * max(3.0 * K, 2.0 * G)
    largest = [highest_frequency2(spread * generator.uniform(size=(count, 3)), K, G) for count in (1, 2, 5, 20)]
    assert max(largest) <= bound * (1.0 + 1e-12)
    assert largest[0] == pytest.approx(bound, rel=1e-12)


def highest_frequency2(x: Array, K: float, G: float) -> float:
    """Square of the highest frequency of particles of unit mass and density on a grid of unit spacing."""
    nodes = np.stack(np.meshgrid(*[np.arange(-2, 6)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    offset = nodes[None] - x[:, None]
    W = spline(offset).prod(axis=2)
    near = W.sum(axis=0) > 0.0
    W, D = W[:, near], 4.0 * (W[..., None] * offset)[:, near]
    unit = np.eye(3)
    L = np.einsum("ac,pib->pabic", unit, D)
    e = 0.5 * (L + L.transpose(0, 2, 1, 3, 4))
    trace = np.einsum("paaic->pic", e)
    s = e - np.einsum("ab,pic->pabic", unit, trace) / 3.0
    n = 3 * W.shape[1]
    stiffness = K * np.einsum("pic,pjd->icjd", trace, trace) + 2.0 * G * np.einsum("pabic,pabjd->icjd", s, s)
    root = np.repeat(W.sum(axis=0) ** -0.5, 3)
    return float(np.linalg.eigvalsh(root[:, None] * stiffness.reshape(n, n) * root)[-1])
