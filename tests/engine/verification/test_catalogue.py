"""Scenes with known answers, and the parts of the engine that only they use."""

import numpy as np
import pytest
import taichi as ti
from typer.testing import CliRunner

from engine.cli import application
from engine.errors import SceneError
from engine.scene.bodies import Box
from engine.scene.fields import validate
from engine.scene.scene import Numerics, Physics, Scene, Wall
from engine.simulation.initial_conditions import initial_state
from engine.verification.catalogue import FULL, SHORT
from engine.verification.check import Problem, difference, share
from engine.verification.harness import Moment, begin, fitted_order, follow
from engine.verification.problems.bar import Bar, Pull
from engine.verification.problems.cliff import Cliff
from engine.verification.problems.collapse import Fall
from engine.verification.problems.column import Column
from engine.verification.problems.expansion import Expansion
from engine.verification.problems.hugoniot import MURNAGHAN, Hugoniot, Shock
from engine.verification.problems.hydrostatic import Hydrostatic
from engine.verification.problems.rotation import Rotation
from engine.verification.problems.rubble import Rubble
from engine.verification.problems.stiffness import apart

HUGONIOT = {  # up: Us [m/s], P [GPa], rho/rho0 of Tillotson's basalt, strengthless
    25.0: (3182.2, 0.2148, 1.00792),
    50.0: (3219.8, 0.4347, 1.01577),
    100.0: (3295.1, 0.8897, 1.03130),
    200.0: (3446.2, 1.861, 1.06161),
    500.0: (3904.5, 5.271, 1.14686),
    1000.0: (4683.9, 12.65, 1.27145),
    2000.0: (6298.0, 34.01, 1.46534),
}

FAST = [
    Hydrostatic(),
    Rotation(particles=300),
    Expansion(particles=300),
    Column(cells=(16, 32)),
    Hugoniot(speeds=(500.0,)),
    Hugoniot(speeds=(500.0,), cells=40, material=MURNAGHAN, name="hugoniot_murnaghan"),
    Bar(rates=(0.1, 1.0)),
    Rubble(particles=100, end_time=400.0),
]


def assert_solved(problem: Problem) -> None:
    assert not [check for check in problem.checks() if not check.passed]


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("problem", FAST, ids=lambda problem: problem.name)
def test_small_problems_are_solved(problem):
    assert_solved(problem)


@pytest.mark.slow
@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("name", list(SHORT))
def test_problems_are_solved(name):
    assert_solved(SHORT[name])


@pytest.mark.slow
@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize("name", [name for name in FULL if FULL[name] != SHORT.get(name)])
def test_fine_problems_are_solved(name):
    assert_solved(FULL[name])


def test_profiles_hold_the_area_of_the_rubble_and_are_flat_where_it_is():
    cliff = Cliff()
    block = initial_state(cliff.scene)
    L, H = cliff.profile(Moment(0.0, block))
    assert H.sum() * (L[1] - L[0]) == pytest.approx(cliff.aspect, rel=1e-12)
    # two strips from the free face
    np.testing.assert_allclose(H[:8], cliff.aspect, rtol=1e-12)
    generator = np.random.default_rng(1)
    strewn = {"x": generator.uniform(0.0, 5.0, (1000, 3)), "j": generator.uniform(0.0, 1.0, 1000)}
    L, H = cliff.profile(Moment(0.0, strewn))
    area = (1.0 + strewn["j"]).sum() * cliff.scene.bodies[0].spacing ** 3 / cliff.scene.period[1]
    assert H.sum() * (L[1] - L[0]) == pytest.approx(area, rel=1e-12)


def test_profiles_are_compared_up_to_the_farther_front():
    long, short = np.array([2.0, 1.0, 0.5, 0.0]), np.array([2.0, 1.3])
    assert apart(long, short) == apart(short, long) == pytest.approx(np.sqrt((0.3**2 + 0.5**2) / 3.0))
    assert apart(long, long) == 0.0


@pytest.mark.parametrize("up", list(HUGONIOT))
def test_exact_shocks_are_the_published_ones(up):
    Us, gigapascals, ratio = HUGONIOT[up]
    shock = Shock(up)
    # the last printed digit
    assert shock.Us == pytest.approx(Us, abs=0.05)
    np.testing.assert_allclose(shock.P, 1e9 * gigapascals, rtol=4e-4)
    assert 1.0 + shock.compression == pytest.approx(ratio, abs=6e-6)


@pytest.mark.parametrize("rate", Bar().rates)
def test_bars_are_pulled_beyond_their_peak(rate):
    stress = Pull(rate).reference()
    assert stress.argmax() < 0.7 * len(stress)


def test_the_exact_collapse_takes_1278_seconds():
    assert Fall(100).collapse_time == pytest.approx(1278.0, abs=0.5)


def test_a_check_that_is_not_a_number_fails_unless_it_is_only_reported():
    assert not difference("x", "m", np.nan, 0.0, 1.0).passed
    assert difference("x", "m", np.nan, 0.0, np.inf).passed
    assert share("x", "m", 1.01, 1.0, 0.02).passed
    assert not share("x", "m", 1.03, 1.0, 0.02).passed
    assert share("x", "m", 1.03, 1.0, 0.02, of=2.0).passed


def test_the_fitted_order_of_a_power_law_is_its_exponent():
    assert fitted_order([1.0, 2.0, 4.0], [3.0, 12.0, 48.0]) == pytest.approx(2.0)


def test_an_unknown_problem_is_refused_with_the_nearest_name():
    result = CliRunner().invoke(application, ["verify", "slop"])
    assert result.exit_code == 2
    assert "did you mean 'slope'" in result.output


@pytest.mark.slow
@pytest.mark.usefixtures("taichi")
def test_the_affine_velocity_of_the_talk_gains_angular_momentum(monkeypatch):
    """C = L (I + dt L)^-1 in full, the published form, breaks what ours keeps."""

    @ti.func
    def published(L, dt, j):
        return L @ (ti.Matrix.identity(ti.f64, 3) + dt * L).inverse()

    monkeypatch.setattr("engine.mpm.apic.affine_velocity", published)
    before, after = Rubble(particles=300).drift()
    assert after / before > 1.01


# periodic axes and walls


def box_scene(velocity: tuple[float, float, float] = (0.0, 0.0, 0.0), **physics: object) -> Scene:
    """A block of 8 x 4 x 4 cells of 1 m, periodic along x, one particle a cell."""
    body = Box(size=(8.0, 4.0, 4.0), lattice=(8, 4, 4), position=(4.0, 2.0, 2.0), velocity=velocity)
    parts = Physics.model_validate({"strength": False, "fracture": None, "gravity": None, **physics})
    return Scene(
        bodies=(body,),
        period=(8.0, None, None),
        end_time=0.02,
        physics=parts,
        numerics=Numerics(particles_per_cell=1.0),
    )


@pytest.mark.usefixtures("taichi")
def test_matter_flows_through_a_periodic_axis_unchanged():
    scene = box_scene(velocity=(1000.0, 0.0, 0.0))
    end = follow(begin(scene), 0.02)
    moved = initial_state(scene)["x"][:, 0] + 20.0
    # round-off of some 200 steps
    assert np.abs((end.x[:, 0] - moved + 4.0) % 8.0 - 4.0).max() < 1e-10
    assert np.abs(end.J - 1.0).max() < 1e-12
    np.testing.assert_allclose(end.v, np.tile([1000.0, 0.0, 0.0], (128, 1)), atol=1e-9)


@pytest.mark.usefixtures("taichi")
def test_results_do_not_depend_on_where_the_period_begins():
    scene = box_scene()
    x = initial_state(scene)["x"]
    v = np.outer(np.sin(np.pi * x[:, 0] / 4.0), [1.0, 0.0, 0.0])
    here = follow(begin(scene, v=v), 0.02)
    there = follow(begin(scene, v=v, x=x + np.array([4.0, 0.0, 0.0])), 0.02)
    np.testing.assert_allclose(here.v, there.v, atol=1e-12)


@pytest.mark.usefixtures("taichi")
def test_a_wall_takes_away_what_moves_into_it():
    """Nothing flows through a smooth wall, and what slides along it is not slowed."""
    wall = {"point": [0.0, -0.5, 0.0], "normal": [0.0, 2.0, 0.0]}
    scene = box_scene(velocity=(3.0, -1.0, 0.0), walls=[wall])
    end = follow(begin(scene), 0.02)
    assert end.x[:, 1].min() > -0.5
    np.testing.assert_allclose(end.v[:, 0], 3.0, atol=1e-9)


@pytest.mark.usefixtures("taichi")
@pytest.mark.parametrize(
    ("friction", "expected"),
    [(0.0, (3.0, 0.0, 4.0)), (0.5, (2.7, 0.0, 3.6)), (6.0, (0.0, 0.0, 0.0)), ("stick", (0.0, 0.0, 0.0))],
)
def test_a_wall_slows_a_node_by_coulombs_impulse(friction, expected):
    from engine.mpm.walls import Walls

    walls = Walls([Wall(normal=(0.0, 1.0, 0.0), friction=friction)])
    held = ti.Vector.field(3, ti.f64, 3)

    @ti.kernel
    def hold():
        held[0] = walls.apply(ti.Vector([0.0, 0.0, 0.0]), ti.Vector([3.0, -1.0, 4.0]))
        held[1] = walls.apply(ti.Vector([0.0, 0.1, 0.0]), ti.Vector([3.0, -1.0, 4.0]))
        held[2] = walls.apply(ti.Vector([0.0, -1.0, 0.0]), ti.Vector([3.0, 1.0, 4.0]))

    hold()
    np.testing.assert_allclose(held[0], expected, atol=1e-14)
    # a node in front of the wall is free, and one behind it may leave unless the wall sticks
    np.testing.assert_array_equal(held[1], (3.0, -1.0, 4.0))
    np.testing.assert_array_equal(held[2], (0.0, 0.0, 0.0) if friction == "stick" else (3.0, 1.0, 4.0))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"period": [7.0, None, None]}, "multiple"),
        ({"physics": {"gravity": {}, "uniform_gravity": [0.0, 0.0, -1.0]}}, "uniform_gravity"),
        ({"period": [8.0, None, None], "physics": {}}, "self-gravity"),
        ({"physics": {"walls": [{"normal": [0.0, 0.0, 0.0]}]}}, "normal"),
        ({"bodies": [{"size": [1.0, 1.0, 1.0], "lattice": [1, 1, 0]}]}, "lattice"),
    ],
)
def test_wrong_parts_are_refused(change, told):
    table = box_scene().model_dump(mode="json")
    with pytest.raises(SceneError, match=told):
        validate(Scene, {**table, **change}, "scene")


def test_a_scene_of_boxes_survives_its_json():
    scene = box_scene(walls=[{"friction": "stick"}])
    assert Scene.model_validate_json(scene.canonical()) == scene
