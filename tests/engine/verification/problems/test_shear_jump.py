"""Width of a jump of velocity."""

import numpy as np
import pytest

from engine.verification.harness import Harness
from engine.verification.problems.shear_jump import ShearJump, _width


def test_the_width_is_that_between_10_and_90_percent_next_to_the_middle():
    z = np.linspace(0.0, 10.0, 201)
    assert _width(z, np.clip((z - 4.0) / 2.0, 0.0, 1.0)) == pytest.approx(1.6)
    # an overshoot far away does not count
    assert _width(z, np.clip((z - 4.0) / 2.0, 0.0, 1.0) + 0.2 * (z < 1.0) - 0.2 * (z > 9.0)) == pytest.approx(1.6)


@pytest.mark.usefixtures("taichi")
def test_a_jump_in_yielding_rubble_widens_with_every_step():
    widths = list(ShearJump(steps=(1, 10, 100)).widths(Harness()))
    (first, _), (tenth, _), (hundredth, scatter) = widths
    assert 0.4 < first < tenth < hundredth
    # more than the filter of the transfer and its reversal by friction would be a force that is not there
    assert tenth < 3.0
    assert hundredth < 5.0
    # nothing differs along the layer but by round-off
    assert scatter < 1e-9
