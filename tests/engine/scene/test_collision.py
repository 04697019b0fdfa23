import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from engine.errors import SceneError
from engine.scene.collision import Collision
from engine.scene.fields import validate
from engine.scene.material import PARAMETER_SETS, FractureRules
from engine.scene.scene import Scene, Sphere
from tests.helpers.oracle import FRICTION

G_N = 6.6743e-11
SETTINGS = {
    "velocity": st.floats(55.0, 2000.0),
    "angle": st.floats(0.0, 89.0),
    "radius": st.floats(1e3, 6e4),
    "projectile_radius": st.one_of(st.none(), st.floats(1e3, 6e4)),
    "particles": st.integers(1, 4000),
}


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
    radii = [settings["radius"], settings["projectile_radius"] or settings["radius"]]
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
    scene = Collision(velocity=v, angle=angle, projectile_radius=small).scene()
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
    assert [body.material.damaged_friction for body in scene.bodies] == [FRICTION[name], FRICTION[name]]
    assert scene.physics.fracture.flaws == flaws
    other = {"friction": 0.5, "fracture": {"flaws": "2NlnN", "growth_speed": 0.3}}
    scene = Collision.model_validate({"velocity": 200, "angle": 15, "parameter_set": name, **other}).scene()
    assert scene.bodies[0].material.damaged_friction == 0.5
    assert scene.physics.fracture.growth_speed == 0.3


@pytest.mark.parametrize("name", PARAMETER_SETS)
def test_a_rule_of_fracture_leaves_the_others_of_the_set(name):
    given = {"velocity": 200.0, "angle": 15.0, "parameter_set": name, "fracture": {"growth_range": 2.0}}
    collision = Collision.model_validate(given)
    rules = PARAMETER_SETS[name].fracture.model_copy(update={"growth_range": 2.0})
    assert collision.scene().physics.fracture == rules
    assert Collision.model_validate(given | {"fracture": FractureRules(growth_range=2.0)}) == collision
    assert Collision.model_validate_json(collision.canonical()) == collision


def test_false_leaves_parts_out():
    parts = {"fracture": False, "gravity": False, "viscosity": False, "output": {"snapshot_interval": False}}
    collision = Collision.model_validate({"velocity": 200.0, "angle": 15.0, **parts})
    scene = collision.scene()
    assert scene.physics.fracture is scene.physics.gravity is scene.physics.viscosity is None
    assert scene.output.snapshot_interval is None
    assert Collision.model_validate_json(collision.canonical()) == collision


@given(st.fixed_dictionaries(SETTINGS))
def test_equal_numbers_make_equal_jobs(settings):
    as_floats = {key: value if value is None else float(value) for key, value in settings.items()}
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


BAD = {
    "no speed": ({"velocity": 0.0}, "'velocity'", "greater than 0", "0.0"),
    "no number": ({"velocity": "fast"}, "'velocity'", "number", "'fast'"),
    "not a number": ({"velocity": float("nan")}, "'velocity'", "nan"),
    "infinite": ({"radius": float("inf")}, "'radius'", "finite", "inf"),
    "backward": ({"angle": -1.0}, "'angle'", "greater than or equal to 0", "-1.0"),
    "beyond grazing": ({"angle": 91.0}, "'angle'", "less than or equal to 90", "91.0"),
    "fraction of a particle": ({"particles": 10.5}, "'particles'", "10.5"),
    "misspelt": ({"raduis": 1e4}, "unknown key 'raduis'", "did you mean 'radius'"),
    "misspelt within": ({"numerics": {"cfi": 0.1}}, "unknown key 'numerics.cfi'", "did you mean 'cfl'"),
    "misspelt material": ({"material": {"eos": {"e0": 1.0}}}, "material.eos.e0", "did you mean 'E0'"),
    "misspelt set": ({"parameter_set": "tolk"}, "unknown parameter_set 'tolk'", "did you mean 'talk'"),
    "start inside": ({"start_separation": 1.0}, "'start_separation'", "greater than 1", "1.0"),
    "ends at contact": ({"end_time": 0.0}, "end_time", "0.0", "greater than 0"),
    "large step": ({"numerics": {"cfl": 1.5}}, "'numerics.cfl'", "1.5"),
    "friction in the material": ({"material": {"damaged_friction": 0.5}}, "'material'", "give 'friction'"),
    "yes for fracture": ({"fracture": True}, "'fracture'", "a table of keys or False", "True"),
    "misspelt rule": ({"fracture": {"growth": 1}}, "unknown key 'fracture.growth'", "did you mean 'growth_"),
    "nonsense flaws": ({"fracture": {"flaws": "many"}}, "'fracture.flaws'", "'covered' or '2NlnN'", "'many'"),
    "switch for a speed": ({"velocity": True}, "'velocity'", "a number, not true or false", "True"),
    "switch for a seed": ({"seed": False}, "'seed'", "a number, not true or false", "False"),
    "switch for what has a default": ({"friction": False}, "'friction'", "a number, not true or false"),
    "too many particles": ({"particles": 10**10}, "'particles'", "less than or equal to 1073741824"),
    "too many particles in the projectile": (
        {"projectile_radius": 1e7},
        "'projectile_radius' 10000000.0 m",
        "at most 1.89e+06 m",
    ),
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
