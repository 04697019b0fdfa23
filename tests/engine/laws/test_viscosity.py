import numpy as np
import pytest

from engine.laws.viscosity import Inviscid, Viscosity
from engine.scene.scene import ViscosityCoefficients
from tests.helpers.device import Array, evaluate, norm, worst

pytestmark = pytest.mark.usefixtures("taichi")

DX = 6.5e3
NU, ZETA, LINEAR, QUADRATIC = 2e5, 3e5, 0.7, 1.9


def states(count: int = 4000) -> tuple[Array, Array, Array]:
    """Symmetric velocity gradients of either sign and all sizes, density, sound speed."""
    generator = np.random.default_rng(1)
    d = generator.normal(size=(count, 3, 3)) * 10.0 ** generator.uniform(-8.0, 1.0, (count, 1, 1))
    return d + d.transpose(0, 2, 1), generator.uniform(50.0, 9000.0, count), generator.uniform(300.0, 9000.0, count)


def viscous(d: Array, rho: Array, c: Array, **coefficients: float) -> list[Array]:
    law = Viscosity(ViscosityCoefficients.model_validate(coefficients), DX)
    return evaluate(law.stress, np.arange(len(d), dtype=np.int32), d, rho, c, outputs=((3, 3), ()))


def parts(d: Array) -> tuple[Array, Array, Array]:
    """Rate of expansion, its tensor, and the deviatoric rate."""
    rate = np.trace(d, axis1=1, axis2=2)
    isotropic = rate[:, None, None] * np.eye(3)
    return rate, isotropic, d - isotropic / 3.0


def test_newtonian_stress_equals_the_closed_form():
    d, rho, c = states()
    _, isotropic, deviatoric = parts(d)
    stress, diffusivity = viscous(d, rho, c, shear=NU, bulk=ZETA)
    expected = rho[:, None, None] * (2.0 * NU * deviatoric + ZETA * isotropic)
    assert worst(stress, expected, norm(expected)) < 1e-14
    assert worst(diffusivity, np.full(len(d), NU + ZETA), NU + ZETA) < 1e-15


def test_shock_viscosity_is_a_pressure_in_compression_and_nothing_in_expansion():
    d, rho, c = states()
    rate, _, _ = parts(d)
    stress, diffusivity = viscous(d, rho, c, shock_linear=LINEAR, shock_quadratic=QUADRATIC)
    closing = np.maximum(-rate, 0.0) * DX
    speed = LINEAR * c + QUADRATIC * closing
    expected = -(rho * closing * speed)[:, None, None] * np.eye(3)
    assert worst(stress, expected, norm(expected)) < 1e-14
    assert worst(diffusivity, (rate < 0.0) * DX * speed, DX * speed) < 1e-14
    assert np.array_equal(stress[rate >= 0.0], np.zeros_like(stress[rate >= 0.0]))


def test_all_viscosities_add():
    d, rho, c = states()
    newtonian = viscous(d, rho, c, shear=NU, bulk=ZETA)
    shock = viscous(d, rho, c, shock_linear=LINEAR, shock_quadratic=QUADRATIC)
    both = viscous(d, rho, c, shear=NU, bulk=ZETA, shock_linear=LINEAR, shock_quadratic=QUADRATIC)
    assert worst(both[0], newtonian[0] + shock[0], norm(newtonian[0]) + norm(shock[0])) < 1e-14
    assert worst(both[1], newtonian[1] + shock[1], both[1]) < 1e-14


def test_viscosity_never_gives_work_back():
    d, rho, c = states()
    stress, _ = viscous(d, rho, c, shear=NU, bulk=ZETA, shock_linear=LINEAR, shock_quadratic=QUADRATIC)
    assert (np.einsum("nij,nij->n", stress, d) >= 0.0).all()


def test_rigid_motion_and_inviscid_matter_bear_no_viscous_stress():
    d, rho, c = states(100)
    assert not viscous(np.zeros_like(d), rho, c, shear=NU, bulk=ZETA, shock_linear=LINEAR)[0].any()
    stress, diffusivity = evaluate(Inviscid().stress, np.arange(100, dtype=np.int32), d, rho, c, outputs=((3, 3), ()))
    assert not stress.any() and not diffusivity.any()
