"""Observed orders of convergence of known power laws."""

import numpy as np
import pytest

from analysis.accuracy.orders import observed_order


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("finest", [0.0, 0.5])
def test_observed_order(order: float, finest: float) -> None:
    coarse, fine = (-7.0 * (h**order - finest**order) for h in (2.0, 1.0))
    assert observed_order(coarse, fine, (2.0, 1.0, finest)) == pytest.approx(order)


@pytest.mark.parametrize(("coarse", "fine"), [(1.0, -1.0), (1.0, 1.0), (0.0, 1.0), (1.0, 2.0)])
def test_no_order_where_errors_do_not_shrink(coarse: float, fine: float) -> None:
    assert np.isnan(observed_order(coarse, fine, (2.0, 1.0, 0.5)))
