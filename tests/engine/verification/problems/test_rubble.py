"""Angular momentum of sheared rubble depends on the affine velocity of the transfer."""

import pytest
import taichi as ti

from engine.verification.harness import Harness
from engine.verification.problems.rubble import Rubble


@pytest.mark.slow
@pytest.mark.usefixtures("taichi")
def test_the_affine_velocity_of_the_talk_gains_angular_momentum(monkeypatch):
    """C (I + dt C)^-1 in full, the published form, breaks what ours keeps."""

    @ti.func
    def published(C, dt, j, steepest):
        return C @ (ti.Matrix.identity(ti.f64, 3) + dt * C).inverse()

    monkeypatch.setattr("engine.mpm.filtered.affine_velocity", published)
    before, after = Rubble(particles=300).drift(Harness())
    assert after / before > 1.01
