"""What every equation of state must answer on the host, form by form."""

import numpy as np
import pytest
from scipy.integrate import quad

from engine.errors import SceneError
from engine.scene.fields import validate
from engine.scene.material import Material, named
from engine.scene.murnaghan import MurnaghanParameters
from engine.scene.scene import Scene
from engine.scene.tillotson import TillotsonParameters

RHO0 = 2700.0
FORMS = [named("basalt").eos, named("ice").eos, MurnaghanParameters(K=2.0e10, n=5.5)]
forms = pytest.mark.parametrize("eos", FORMS, ids=lambda eos: f"{eos.form}-{eos.bulk_modulus():g}")


@forms
@pytest.mark.parametrize("keeps_energy", [True, False])
def test_matter_at_rest_has_the_pressure_it_was_compressed_by(eos, keeps_energy):
    P = np.concatenate([[0.0], np.geomspace(1e4, 1e8, 20)])
    mu, E = eos.compression_at(P, RHO0, keeps_energy)
    found = eos.pressure(RHO0, mu, E)
    np.testing.assert_allclose(found, P, rtol=1e-8)
    assert mu[0] == E[0] == 0.0 and (np.diff(mu) > 0.0).all()
    assert (E[1:] > 0.0).all() if keeps_energy else not E.any()


@forms
def test_matter_at_rest_has_the_energy_of_its_compression(eos):
    mu, E = eos.compression_at(np.geomspace(1e6, 1e8, 5), RHO0, True)
    expected = [eos.cold_energy(RHO0, 1.0 + compression) for compression in mu]
    # Tillotson's is that of elastic strain, to leading order in mu < 0.02
    np.testing.assert_allclose(E, expected, rtol=0.02)


@forms
def test_the_bulk_modulus_is_the_slope_at_rest(eos):
    step = 1e-6
    slope = (eos.pressure(RHO0, step, 0.0) - eos.pressure(RHO0, -step, 0.0)) / (2.0 * step)
    assert eos.bulk_modulus() == pytest.approx(slope, rel=1e-8)


@forms
@pytest.mark.parametrize("eta", [0.9, 1.0, 1.01, 2.0, 30.0])
def test_the_cold_energy_is_the_work_of_the_cold_pressure(eos, eta):
    work, _ = quad(lambda x: eos.pressure(RHO0, x - 1.0, 0.0) / (RHO0 * x**2), 1.0, eta, epsrel=1e-11)
    assert eos.cold_energy(RHO0, eta) == pytest.approx(work, rel=1e-8)


@forms
def test_softer_matter_has_a_slower_sound_and_the_same_curve(eos):
    soft, mu = eos.softened(0.3), np.linspace(-0.2, 1.0, 50)
    assert soft.bulk_modulus() == pytest.approx(0.09 * eos.bulk_modulus(), rel=1e-14)
    np.testing.assert_allclose(soft.pressure(RHO0, mu, 0.0), 0.09 * eos.pressure(RHO0, mu, 0.0), rtol=1e-12)
    assert soft.vaporisation_energy() == eos.vaporisation_energy()
    assert eos.softened(1.0) == eos


def test_only_a_form_with_vapour_has_an_energy_of_it():
    assert named("basalt").eos.vaporisation_energy() == 4.72e6
    assert MurnaghanParameters(K=2.0e10, n=5.5).vaporisation_energy() == np.inf


def test_the_form_chooses_the_constants_and_tillotson_is_the_default():
    constants = named("ice").eos.constants()
    own = Material.model_validate({"rho0": 900.0, "shear_modulus": 1e9, "eos": constants})
    assert own.eos == TillotsonParameters(**constants) == named("ice").eos
    changed = named("basalt", eos={"form": "murnaghan", "K": 1e9, "n": 7})
    assert changed.eos == MurnaghanParameters(K=1e9, n=7.0)
    assert Material.model_validate(changed.model_dump()) == changed


BAD = {
    "old key": ({"tillotson": {"A": 1e9}}, "'tillotson' is now 'eos'"),
    "unknown form": ({"eos": {"form": "ideal"}}, "'eos'", "'tillotson' or 'murnaghan'"),
    "missing constant": ({"eos": {"form": "murnaghan", "K": 1e9}}, "missing key 'eos.n'"),
    "constant of another form": ({"eos": {"form": "murnaghan", "A": 1e9, "n": 4}}, "'eos.A'", "form, K, n"),
    "energy that diverges": ({"eos": {"form": "murnaghan", "K": 1e9, "n": 1}}, "'eos.n'", "greater than 1"),
}


@pytest.mark.parametrize(("table", "told"), [(case[0], case[1:]) for case in BAD.values()], ids=list(BAD))
def test_a_wrong_equation_of_state_is_named(table, told):
    with pytest.raises(SceneError) as error:
        validate(Material, {"name": "basalt", **table}, "scene.toml")
    assert all(part in str(error.value) for part in told), str(error.value)


def test_a_scene_has_one_form():
    stone, ice = (
        {"radius": 1e3, "particles": 10, "material": {"name": "basalt", "eos": eos.model_dump()}} for eos in FORMS[::2]
    )
    with pytest.raises(SceneError, match=r"one form in all bodies .*murnaghan, tillotson"):
        validate(Scene, {"bodies": [stone, ice], "end_time": 1.0}, "scene.toml")
    assert len(validate(Scene, {"bodies": [ice, ice], "end_time": 1.0}, "scene.toml").bodies) == 2
