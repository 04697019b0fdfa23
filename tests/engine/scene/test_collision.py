from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from engine.errors import SceneError
from engine.scene.collision import Collision
from engine.scene.collision_bodies import Projectile
from engine.scene.fields import validate
from engine.scene.material import FractureRules, named
from engine.scene.parameter_sets import PARAMETER_SETS
from engine.scene.scene import Scene, Sphere
from tests.helpers.oracle import FRICTION
from tests.helpers.parameter_sets import rules_of

G_N = 6.6743e-11
SETTINGS = {
    "velocity": st.floats(55.0, 2000.0),
    "angle": st.floats(0.0, 89.0),
    "target": st.fixed_dictionaries({"radius": st.floats(1e3, 6e4)}),
    "projectile": st.fixed_dictionaries({"radius": st.one_of(st.none(), st.floats(1e3, 6e4))}),
    "particles": st.integers(1, 4000),
}


ICE = {"cohesion": 1e6, "intact_friction": 1.0, "melt_energy": 7e5, "friction": 0.6}
"""Guesses in place of what is not published."""


def made(**settings: Any) -> Collision:
    return Collision.model_validate({"velocity": 200.0, "angle": 15.0, "particles": 1000, **settings})


def relative(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Position and velocity of the projectile seen from the target."""
    target, projectile = scene.bodies
    return (
        np.array(projectile.position) - np.array(target.position),
        np.array(projectile.velocity) - np.array(target.velocity),
    )


def weighted(bodies: tuple[Sphere, ...], vectors: list[tuple[float, ...]]) -> np.ndarray:
    return np.array(sum(body.mass * np.array(vector) for body, vector in zip(bodies, vectors, strict=True)))


@given(st.fixed_dictionaries(SETTINGS))
def test_masses_and_rest_of_the_centre_of_mass(settings):
    scene = Collision.model_validate(settings).scene()
    radius = settings["target"]["radius"]
    radii = [radius, settings["projectile"]["radius"] or radius]
    for body, radius in zip(scene.bodies, radii, strict=True):
        assert body.mass == pytest.approx(2700.0 * 4.0 / 3.0 * np.pi * radius**3, rel=1e-14)
    # positions and velocities carry ten digits
    for vectors in ([b.position for b in scene.bodies], [b.velocity for b in scene.bodies]):
        size = sum(b.mass * np.linalg.norm(v) for b, v in zip(scene.bodies, vectors, strict=True))
        assert np.linalg.norm(weighted(scene.bodies, vectors)) < 2e-9 * size


@given(st.fixed_dictionaries(SETTINGS))
def test_particles_of_both_bodies_have_nearly_one_mass(settings):
    target, projectile = Collision.model_validate(settings).scene().bodies
    assert target.particles == settings["particles"]
    # the projectile's number is rounded
    share = projectile.mass / (target.mass / target.particles)
    assert projectile.particles == max(1, round(share))


@given(v=st.floats(70.0, 500.0), angle=st.floats(0.0, 80.0), small=st.floats(1e4, 5e4))
def test_falling_together_from_the_start_the_bodies_meet_as_asked(v, angle, small):
    scene = Collision(velocity=v, angle=angle, projectile=Projectile(radius=small)).scene()
    mu = G_N * sum(body.mass for body in scene.bodies)
    path = solve_ivp(
        lambda t, y: np.concatenate([y[3:], -mu * y[:3] / np.linalg.norm(y[:3]) ** 3]),
        (scene.start_time, 0.0),
        np.concatenate(relative(scene)),
        rtol=1e-11,
        atol=1e-6,
    )
    contact = 50e3 + small
    direction = np.array([np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle)), 0.0])
    # ten digits at the start, stretched by the fall
    np.testing.assert_allclose(path.y[:3, -1], contact * direction, atol=1e-6 * contact)
    np.testing.assert_allclose(path.y[3:, -1], [-v, 0.0, 0.0], atol=1e-6 * v)


def test_the_published_impact_starts_at_four_radii():
    x, v = relative(Collision(velocity=200.0, angle=15.0).scene())
    assert np.linalg.norm(x) == pytest.approx(200e3, rel=1e-9)
    assert np.linalg.norm(v) == pytest.approx(195.2, abs=0.05)


def test_without_gravity_bodies_fly_straight_and_start_without_pressure():
    scene = Collision(velocity=200.0, angle=30.0, gravity=None).scene()
    x, v = relative(scene)
    np.testing.assert_allclose(v, [-200.0, 0.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(x - scene.start_time * v, 100e3 * np.array([3**0.5 / 2, 0.5, 0.0]), rtol=1e-8, atol=1e-3)
    assert scene.physics.gravity is None
    assert not any(body.hydrostatic for body in scene.bodies)


@pytest.mark.parametrize(("name", "flaws"), [("sugiura2018", "covered"), ("talk", "2NlnN")])
def test_a_parameter_set_fixes_friction_and_fracture_unless_they_are_given(name, flaws):
    scene = Collision(velocity=200.0, angle=15.0, parameter_set=name).scene()
    assert [body.material.friction for body in scene.bodies] == [FRICTION[name], FRICTION[name]]
    assert scene.physics.fracture.flaws == flaws
    other = {"materials": {"basalt": {"friction": 0.5}}, "fracture": {"flaws": "2NlnN", "growth_speed": 0.3}}
    scene = Collision.model_validate({"velocity": 200, "angle": 15, "parameter_set": name, **other}).scene()
    assert scene.bodies[0].material.friction == 0.5
    assert scene.physics.fracture.growth_speed == 0.3


@pytest.mark.parametrize("name", PARAMETER_SETS)
def test_a_rule_of_fracture_leaves_the_others_of_the_set(name):
    given = {"velocity": 200.0, "angle": 15.0, "parameter_set": name, "fracture": {"growth_range": 2.0}}
    collision = Collision.model_validate(given)
    rules = rules_of(name).model_copy(update={"growth_range": 2.0})
    assert collision.scene().physics.fracture == rules
    assert Collision.model_validate(given | {"fracture": rules}) == collision
    assert Collision.model_validate_json(collision.canonical()) == collision


def test_the_constants_of_a_set_lie_under_every_table_that_starts_from_their_material():
    tables = {"mine": {"name": "basalt", "weibull_k": 1e35}, "slick": {"name": "basalt", "friction": 0.3}}
    talk = made(parameter_set="talk", materials=tables).materials
    assert (talk["basalt"].friction, talk["mine"].friction, talk["slick"].friction) == (0.945, 0.945, 0.3)
    assert talk["mine"].weibull_k == 1e35
    frozen = made(parameter_set="talk", materials={"basalt": {"name": "ice"}}).materials["basalt"]
    assert frozen.friction is None
    collision = made(parameter_set="talk", materials=tables, target={"material": "mine"})
    assert Collision.model_validate_json(collision.canonical()) == collision


def test_rules_given_in_python_leave_the_others_of_the_set_and_a_material_given_in_python_is_complete():
    rules = Collision(velocity=1.0, angle=1.0, parameter_set="talk", fracture=FractureRules(growth_range=2.0)).fracture
    assert rules == rules_of("talk").model_copy(update={"growth_range": 2.0})
    collision = Collision(velocity=1.0, angle=1.0, parameter_set="talk", materials={"basalt": named("basalt")})
    assert collision.materials == {"basalt": named("basalt")}


def test_the_set_of_sugiura_2018_leaves_basalt_as_it_ships():
    collision = Collision(velocity=200.0, angle=15.0)
    assert collision.materials == {"basalt": named("basalt")}
    assert collision.fracture == FractureRules()


def test_the_set_of_the_talk_differs_in_friction_and_fracture_only():
    s18, talk = (Collision(velocity=200.0, angle=15.0, parameter_set=name).scene() for name in ("sugiura2018", "talk"))
    rules = FractureRules(flaws="2NlnN", strain="young", growth_speed=0.5, growth_range=3.0, per_flaw=False)
    physics = s18.physics.model_copy(update={"fracture": rules})
    rock = s18.bodies[0].material.model_copy(update={"friction": 0.945})
    bodies = tuple(body.model_copy(update={"material": rock}) for body in s18.bodies)
    assert talk == s18.model_copy(update={"physics": physics, "bodies": bodies})


def test_each_body_has_its_own_material_and_the_projectile_is_like_the_target_unless_it_says():
    tables = {"materials": {"ice": ICE}, "projectile": {"material": "ice"}}
    target, projectile = made(**tables).scene().bodies
    assert target.material == named("basalt") and projectile.material == named("ice", **ICE)
    # the same spacing, not the same mass per particle
    assert projectile.spacing == target.spacing
    assert projectile.mass / target.mass == pytest.approx(917.0 / 2700.0, rel=1e-14)
    both = made(target={"material": "ice", "radius": 1e4}, materials={"ice": ICE}).scene().bodies
    assert {(body.material.name, body.radius) for body in both} == {("ice", 1e4)}


def test_a_material_of_its_own_may_start_from_a_shipped_one():
    rubble = {"name": "basalt", "rho0": 2000.0}
    body = made(target={"material": "rubble"}, materials={"rubble": rubble}).scene().bodies[0]
    assert body.material == named("basalt", rho0=2000.0)
    own = {**named("ice", **ICE).model_dump(exclude={"name"}), "rho0": 800.0}
    collision = made(target={"material": "firn"}, materials={"firn": own})
    assert collision.scene().bodies[1].material.rho0 == 800.0
    assert Collision.model_validate_json(collision.canonical()) == collision


def test_what_a_material_lacks_is_asked_for_by_its_key():
    with pytest.raises(SceneError, match=r"'materials\.ice' lacks cohesion, .*, which strength needs: give them"):
        made(projectile={"material": "ice"}).scene()
    unknown = {**ICE, "weibull_k": None}
    with pytest.raises(SceneError, match=r"'materials\.ice' lacks weibull_k, which fracture needs: .*fracture = false"):
        made(projectile={"material": "ice"}, materials={"ice": unknown}).scene()
    assert made(projectile={"material": "ice"}, materials={"ice": unknown}, fracture=False).scene()


def spin_momentum(body: Sphere) -> np.ndarray:
    """Angular momentum of a body about its centre [kg m^2/s]."""
    return 0.4 * body.mass * body.radius**2 * np.array(body.spin)


@pytest.mark.parametrize(
    ("obliquity", "axis"),
    [
        (0.0, (0.0, 0.0, 1.0)),
        (90.0, (1.0, 0.0, 0.0)),
        (180.0, (0.0, 0.0, -1.0)),
        (60.0, (3**0.5 / 2.0, 0.0, 0.5)),
    ],
)
def test_a_period_and_an_obliquity_make_a_spin(obliquity, axis):
    scene = made(target={"spin_period": 4.0, "spin_obliquity": obliquity}).scene()
    target, projectile = scene.bodies
    rate = 2.0 * np.pi / (4.0 * 3600.0)
    np.testing.assert_allclose(target.spin, rate * np.array(axis), rtol=1e-9, atol=1e-16)
    assert projectile.spin == (0.0, 0.0, 0.0)
    np.testing.assert_allclose(target.spin_momentum, spin_momentum(target), rtol=1e-14)


def test_a_prograde_spin_adds_to_the_angular_momentum_of_the_impact_and_a_retrograde_one_takes_away():
    spins = [{}, {"spin_period": 6.0}, {"spin_period": 6.0, "spin_obliquity": 180.0}]
    momenta = []
    for spin in spins:
        bodies = made(projectile={"radius": 3e4, **spin}).scene().bodies
        orbital = sum(body.mass * np.cross(body.position, body.velocity) for body in bodies)
        momenta.append(orbital + sum(np.array(body.spin_momentum) for body in bodies))
    still, prograde, retrograde = momenta
    assert still[2] > 0.0 and not still[:2].any()
    own = 0.4 * 2700.0 * 4.0 / 3.0 * np.pi * 3e4**5 * 2.0 * np.pi / (6.0 * 3600.0)
    np.testing.assert_allclose(prograde - still, [0.0, 0.0, own], rtol=1e-9)
    np.testing.assert_allclose(retrograde - still, [0.0, 0.0, -own], rtol=1e-9)


@pytest.mark.parametrize("body", ["target", "projectile"])
@pytest.mark.parametrize("period", [1e-307, 1e-6, 0.016])
def test_a_surface_faster_than_waves_in_the_material_is_refused_with_the_least_period(body, period):
    with pytest.raises(SceneError, match=rf"'{body}\.spin_period' {period} h .* give at least (\S+) h") as error:
        made(**{body: {"spin_period": period}}).scene()
    least = float(str(error.value).split()[-2])
    assert least == pytest.approx(2.0 * np.pi * 50e3 / named("basalt").longitudinal_speed / 3600.0, rel=2e-3)
    assert made(**{body: {"spin_period": least}}).scene()


def test_two_forms_of_equation_of_state_are_refused_by_the_keys_of_the_collision():
    hard = {"name": "basalt", "eos": {"form": "murnaghan", "K": 2e10, "n": 4.0}}
    with pytest.raises(SceneError) as error:
        made(materials={"hard": hard}, projectile={"material": "hard"}).scene()
    for words in ("'target.material' basalt", "'projectile.material' hard", "'materials.hard.eos.form' is murnaghan"):
        assert words in str(error.value)
    assert made(materials={"hard": hard}, target={"material": "hard"}).scene()


def test_bodies_may_start_damaged():
    assert [body.damage for body in made(target={"damage": 1.0}).scene().bodies] == [1.0, 0.0]


def test_false_leaves_parts_out():
    parts = {"fracture": False, "gravity": False, "viscosity": False, "output": {"snapshot_interval": False}}
    collision = Collision.model_validate({"velocity": 200.0, "angle": 15.0, **parts})
    scene = collision.scene()
    assert scene.physics.fracture is scene.physics.gravity is scene.physics.viscosity is None
    assert scene.output.snapshot_interval is None
    assert Collision.model_validate_json(collision.canonical()) == collision


@given(st.fixed_dictionaries(SETTINGS))
def test_equal_numbers_make_equal_jobs(settings):
    as_floats = {key: float(value) if isinstance(value, int) else value for key, value in settings.items()}
    reversed_order = dict(reversed(settings.items()))
    one = Collision.model_validate(settings)
    for same in (Collision.model_validate(as_floats), Collision.model_validate(reversed_order)):
        assert one.hash() == same.hash()
        assert one.scene().hash() == same.scene().hash()


def test_whole_numbers_and_floats_are_the_same_job_and_other_values_are_not():
    one, same = (Collision(velocity=v, angle=a) for v, a in ((100, 15), (100.0, 15.0)))
    assert one.hash() == same.hash() and one.scene().hash() == same.scene().hash()
    changes = {"velocity": 100.0000001, "angle": 15.5, "seed": 2, "particles": 19999, "parameter_set": "talk"}
    hashes = {Collision.model_validate({"velocity": 100, "angle": 15, key: v}).hash() for key, v in changes.items()}
    assert len(hashes | {one.hash()}) == len(changes) + 1


OLD_KEYS = {
    "radius": ({"radius": 1e4}, "'radius' is now 'target.radius'"),
    "radius of the projectile": ({"projectile_radius": 1e4}, "'projectile_radius' is now 'projectile.radius'"),
    "friction": ({"friction": 0.5}, "'friction' is now 'materials.basalt.friction'"),
    "material": ({"material": "basalt"}, "'material' is now 'materials.basalt'"),
    "constant of the material": (
        {"material": {"damaged_friction": 0.5}},
        "'material.damaged_friction' is now 'materials.basalt.friction'",
    ),
    "constant of Tillotson": (
        {"material": {"tillotson": {"A": 1e10}}},
        "'material.tillotson.A' is now 'materials.basalt.eos.A'",
    ),
    "damaged friction": (
        {"materials": {"ice": {"damaged_friction": 0.5}}},
        "'materials.ice.damaged_friction' is now 'materials.ice.friction'",
    ),
    "Tillotson": ({"materials": {"basalt": {"tillotson": {}}}}, "basalt.tillotson' is now 'materials.basalt.eos'"),
}


@pytest.mark.parametrize(("change", "told"), OLD_KEYS.values(), ids=OLD_KEYS)
def test_an_old_key_is_refused_with_the_new_one_named(change, told):
    with pytest.raises(SceneError) as error:
        validate(Collision, {"velocity": 200.0, "angle": 15.0, **change}, "study.toml")
    assert str(error.value).startswith("study.toml: ") and str(error.value).endswith(told)
    assert "\n" not in str(error.value)


def test_every_old_key_of_a_table_is_told_its_new_name():
    old = {"rho0": 2600.0, "damaged_friction": 0.5}
    with pytest.raises(SceneError) as error:
        validate(Collision, {"velocity": 200.0, "material": old}, "study.toml")
    assert sorted(line.removeprefix("study.toml: ") for line in str(error.value).splitlines()) == [
        "'material.damaged_friction' is now 'materials.basalt.friction'",
        "'material.rho0' is now 'materials.basalt.rho0'",
        "missing key 'angle'",
    ]


BAD = {
    "no speed": ({"velocity": 0.0}, "'velocity'", "greater than 0", "0.0"),
    "no number": ({"velocity": "fast"}, "'velocity'", "number", "'fast'"),
    "not a number": ({"velocity": float("nan")}, "'velocity'", "nan"),
    "infinite": ({"target": {"radius": float("inf")}}, "'target.radius'", "finite", "inf"),
    "backward": ({"angle": -1.0}, "'angle'", "greater than or equal to 0", "-1.0"),
    "beyond grazing": ({"angle": 91.0}, "'angle'", "less than or equal to 90", "91.0"),
    "fraction of a particle": ({"particles": 10.5}, "'particles'", "10.5"),
    "misspelt": ({"target": {"raduis": 1e4}}, "unknown key 'target.raduis'", "did you mean 'radius'"),
    "misspelt within": ({"numerics": {"cfi": 0.1}}, "unknown key 'numerics.cfi'", "did you mean 'cfl'"),
    "misspelt material": (
        {"materials": {"basalt": {"eos": {"e0": 1.0}}}},
        "materials.basalt.eos.e0",
        "did you mean 'E0'",
    ),
    "misspelt set": ({"parameter_set": "tolk"}, "unknown parameter_set 'tolk'", "did you mean 'talk'"),
    "start inside": ({"start_separation": 1.0}, "'start_separation'", "greater than 1", "1.0"),
    "ends at contact": ({"end_time": 0.0}, "end_time", "0.0", "greater than 0"),
    "large step": ({"numerics": {"cfl": 1.5}}, "'numerics.cfl'", "1.5"),
    "yes for fracture": ({"fracture": True}, "'fracture'", "a table of keys", "True"),
    "misspelt rule": ({"fracture": {"growth": 1}}, "unknown key 'fracture.growth'", "did you mean 'growth_"),
    "nonsense flaws": ({"fracture": {"flaws": "many"}}, "'fracture.flaws'", "'covered' or '2NlnN'", "'many'"),
    "switch for a speed": ({"velocity": True}, "'velocity'", "a number, not true or false", "True"),
    "switch for a seed": ({"seed": False}, "'seed'", "a number, not true or false", "False"),
    "switch for what has a default": ({"sound_speed": False}, "'sound_speed'", "a number, not true or false"),
    "too many particles": ({"particles": 10**10}, "'particles'", "less than or equal to 1073741824"),
    "too many particles in the projectile": (
        {"projectile": {"radius": 1e7}},
        "'projectile.radius' 10000000.0 m",
        "at most 1.89e+06 m",
    ),
    "no table of materials": ({"materials": 3}, "'materials'", "a table of keys", "3"),
    "misspelt choice of material": ({"target": {"material": "icee"}}, "'target.material'", "did you mean 'ice'"),
    "name alone as a material": ({"materials": {"mine": "basalt"}}, "'materials.mine'", 'as {name = "basalt"}'),
    "number as a name": ({"materials": {"mine": {"name": 3}}}, "'materials.mine'", "'name' must be text (given 3)"),
    "misspelt constants": ({"materials": {"bsalt": {"friction": 1}}}, "'bsalt'", "did you mean 'basalt'", "rho0"),
    "key of a material": ({"rho0": 1.0}, "unknown key 'rho0'", "did you mean 'materials.NAME.rho0'"),
    "no day": ({"target": {"spin_period": 0.0}}, "'target.spin_period'", "greater than 0", "0.0"),
    "turned over twice": ({"target": {"spin_obliquity": 200}}, "'target.spin_obliquity'", "equal to 180", "200"),
    "name with a dot": ({"materials": {"a.b": {}}}, "'materials.a.b'", "pattern"),
    "key of numerics": ({"precision": "f32"}, "unknown key 'precision'", "did you mean 'numerics.precision'"),
    "negative seed": ({"seed": -1}, "'seed'", "-1"),
}


@pytest.mark.parametrize(("change", "told"), [(case[0], case[1:]) for case in BAD.values()], ids=list(BAD))
def test_bad_input_is_one_line_with_file_key_value_and_the_way_out(change, told):
    with pytest.raises(SceneError) as error:
        validate(Collision, {"velocity": 200.0, "angle": 15.0, **change}, "study.toml")
    message = str(error.value)
    assert message.startswith("study.toml: ") and "\n" not in message
    for word in told:
        assert word in message


def test_every_mistake_has_its_own_line():
    with pytest.raises(SceneError) as error:
        validate(Collision, {"velocity": -1.0, "anlge": 15.0}, "study.toml")
    lines = str(error.value).splitlines()
    assert len(lines) == 3
    assert any("missing key 'angle'" in line for line in lines)
    assert any("'anlge': did you mean 'angle'" in line for line in lines)
