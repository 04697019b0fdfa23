"""Observed orders of convergence in particle spacing."""

from itertools import pairwise

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from analysis.accuracy.cases import RESOLUTION

ORDERS = (0.05, 12.0)
"""Smallest and largest order that is searched for."""

CONSERVED = ("drift_energy", "drift_angular_momentum")
"""Errors by themselves: 0 in the exact solution."""


def orders(data: xr.Dataset, finest: str) -> dict[str, xr.DataArray]:
    """Return orders between neighbouring resolutions; NaN where the seeds do not resolve both errors, or no order fits.

    Measured outcomes are compared with the finest case; drifts are errors by themselves.

    Args:
        data: accuracy of all cases.
        finest: name of the case with the most particles.
    """
    same = data.sel(case=np.isin(data["setting"], RESOLUTION)).sortby("particles")
    steps = list(pairwise(str(name) for name in same["case"].values))
    measured = {name.removesuffix("_minus_finest"): name for name in map(str, data) if name.endswith("_minus_finest")}
    values = {name: [_to_finest(same, one, two, finest, key) for one, two in steps] for name, key in measured.items()}
    values |= {name: [_by_itself(same, one, two, name) for one, two in steps] for name in CONSERVED}
    labels = [f"{int(same['particles'].sel(case=one))} to {int(same['particles'].sel(case=two))}" for one, two in steps]
    return {
        f"order_{name}": xr.DataArray(
            row,
            dims="refinement",
            coords={"refinement": labels},
            attrs={"long_name": f"observed order in particle spacing of {name}", "units": "1"},
        )
        for name, row in values.items()
    }


def observed_order(coarse: float, fine: float, spacings: tuple[float, float, float]) -> float:
    """Return the order p of q(h) = q0 + C h^p from its differences to the value at the finest of three spacings.

    Args:
        coarse, fine: differences at the first and the second spacing.
        spacings: three spacings, coarsest first; the last may be 0, where q is exact.

    Returns:
        The order; NaN where no order within `ORDERS` fits.
    """
    h1, h2, h3 = spacings

    def misfit(p: float) -> float:
        return float(coarse / fine - (h1**p - h3**p) / (h2**p - h3**p))

    if coarse * fine <= 0.0 or misfit(ORDERS[0]) * misfit(ORDERS[1]) > 0.0:
        return float("nan")
    return float(brentq(misfit, *ORDERS))


def _to_finest(same: xr.Dataset, one: str, two: str, finest: str, name: str) -> float:
    if finest in (one, two) or not same[f"{name}_resolved"].sel(case=[one, two]).all():
        return float("nan")
    h1, h2, h3 = (float(same["spacing"].sel(case=case)) for case in (one, two, finest))
    return observed_order(float(same[name].sel(case=one)), float(same[name].sel(case=two)), (h1, h2, h3))


def _by_itself(same: xr.Dataset, one: str, two: str, name: str) -> float:
    h1, h2 = (float(same["spacing"].sel(case=case)) for case in (one, two))
    return observed_order(float(same[name].sel(case=one)), float(same[name].sel(case=two)), (h1, h2, 0.0))
