"""Lenses of rubble start as the exact solution is, and move as it does."""

import numpy as np
import pytest

from engine.scene.bodies import Sphere
from engine.verification.harness import Harness
from engine.verification.material_point import unpacked
from engine.verification.problems.ellipsoid import BULK, RADIUS, SHEAR, Lens, flat, spinning


@pytest.mark.parametrize("lens", [spinning(3000), flat(0.2, 3000)], ids=["spinning", "flat"])
def test_particles_fill_the_ellipsoid_and_move_linearly(lens):
    start, fields = lens.start, lens.fields()
    x = fields["x"]
    inside = np.linalg.norm(x @ np.linalg.inv(start.F).T, axis=1)
    assert 0.95 < inside.max() < 1.05
    # second moments of a homogeneous ellipsoid
    np.testing.assert_allclose(x.T @ x / len(x), start.F @ start.F.T / 5.0, atol=0.01 * RADIUS**2)
    assert np.linalg.det(start.F) == pytest.approx(RADIUS**3, rel=1e-12)
    assert isinstance(lens.scene.bodies[0], Sphere) and lens.scene.bodies[0].radius == RADIUS
    np.testing.assert_allclose(fields["v"], np.einsum("pij,pj->pi", fields["C"], x))


@pytest.mark.parametrize("lens", [spinning(1000), flat(0.2, 1000)], ids=["spinning", "flat"])
def test_particles_yield_at_the_start_and_their_strain_is_that_of_their_stress(lens):
    fields = lens.fields()
    J = 1.0 + fields["j"]
    sigma = unpacked(fields["tau"]) / J[:, None, None]
    P = -np.trace(sigma, axis1=1, axis2=2) / 3.0
    assert P.max() == pytest.approx(lens.rubble.pressure(lens.start), rel=0.05)
    np.testing.assert_allclose(P, BULK * (1.0 / J - 1.0), atol=1e-9 * BULK)
    s = sigma + P[:, None, None] * np.eye(3)
    np.testing.assert_allclose(np.sqrt(0.5 * np.sum(s**2, axis=(1, 2))), lens.friction * P, atol=1e-6 * P.max())
    b = np.eye(3) + unpacked(fields["b_minus_I"])
    np.testing.assert_allclose(np.linalg.det(b), 1.0, rtol=1e-12)
    np.testing.assert_allclose(SHEAR * (b - np.eye(3)), J[:, None, None] * s, atol=3e-3 * P.max())


@pytest.mark.usefixtures("taichi")
def test_a_lens_spreads_and_turns_as_the_exact_solution_says():
    lens = spinning(500)
    moved = Lens(lens.start, lens.friction, lens.particles, (500.0,)).measure(Harness())
    # 0.5 %, where the lens has become 30 % longer
    assert moved.F < 0.01
    assert moved.ratio == pytest.approx(moved.exact_ratio, rel=0.02)
    assert moved.ratio < 0.7 * lens.start.axes[2] / lens.start.axes[0]
    assert moved.spin < 1e-4
