"""The profile of a collapsing cliff."""

import numpy as np
import pytest

from engine.simulation.initial_conditions import initial_state
from engine.verification.harness import State
from engine.verification.problems.cliff import Cliff


def test_profiles_contain_the_area_of_the_rubble_and_are_flat_where_it_is():
    cliff = Cliff()
    block = initial_state(cliff.scene)
    L, H = cliff.profile(State(0.0, block))
    assert H.sum() * (L[1] - L[0]) == pytest.approx(cliff.aspect, rel=1e-12)
    # two strips from the free face
    np.testing.assert_allclose(H[:8], cliff.aspect, rtol=1e-12)
    generator = np.random.default_rng(1)
    strewn = {"x": generator.uniform(0.0, 5.0, (1000, 3)), "j": generator.uniform(0.0, 1.0, 1000)}
    L, H = cliff.profile(State(0.0, strewn))
    area = (1.0 + strewn["j"]).sum() * cliff.scene.bodies[0].spacing ** 3 / cliff.scene.period[1]
    assert H.sum() * (L[1] - L[0]) == pytest.approx(area, rel=1e-12)
