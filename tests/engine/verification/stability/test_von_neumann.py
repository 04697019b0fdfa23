"""The largest stable time step: closed forms of the theory, and the engine beside it."""

import numpy as np
import pytest

from engine.verification.stability.von_neumann import BLOCKS, Block


def test_limits_of_the_time_step_have_closed_forms_for_one_particle_a_cell_and_for_many() -> None:
    # one particle in the middle of a cell: at the shortest wave K = 4 c^2/dx^2 and T = 1
    assert Block((4, 4, 4)).theory() == pytest.approx(1.0, abs=2e-3)
    # without end of them: at the wave of four cells K = 52/35 c^2/dx^2 and T = 19/21, and the filter acts in full,
    # dt^2 K T = 2 (1 + 2 T - T^2)
    assert Block((12, 12, 12)).theory() == pytest.approx(np.sqrt(2195.0 / 741.0), abs=5e-3)


@pytest.mark.usefixtures("taichi")
def test_the_engine_has_the_limit_of_theory() -> None:
    block = BLOCKS[0]
    limit = block.theory()
    assert block.decays(0.98 * limit) and not block.decays(1.02 * limit)
