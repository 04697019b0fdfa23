"""Exact shocks."""

import numpy as np
import pytest

from engine.verification.problems.hugoniot import Shock

HUGONIOT = {  # up: Us [m/s], P [GPa], rho/rho0 of Tillotson's basalt, strengthless
    25.0: (3182.2, 0.2148, 1.00792),
    50.0: (3219.8, 0.4347, 1.01577),
    100.0: (3295.1, 0.8897, 1.03130),
    200.0: (3446.2, 1.861, 1.06161),
    500.0: (3904.5, 5.271, 1.14686),
    1000.0: (4683.9, 12.65, 1.27145),
    2000.0: (6298.0, 34.01, 1.46534),
}


@pytest.mark.parametrize("up", list(HUGONIOT))
def test_exact_shocks_are_the_published_ones(up):
    Us, gigapascals, ratio = HUGONIOT[up]
    shock = Shock(up)
    # the last printed digit
    assert shock.Us == pytest.approx(Us, abs=0.05)
    np.testing.assert_allclose(shock.P, 1e9 * gigapascals, rtol=4e-4)
    assert 1.0 + shock.compression == pytest.approx(ratio, abs=6e-6)
