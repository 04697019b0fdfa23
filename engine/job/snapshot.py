"""Particles at one time as a data set."""

import numpy as np
import xarray as xr
from numpy.typing import DTypeLike, NDArray

from engine.arrays import Scalars
from engine.job.storage import Attributes
from engine.quantities import PARTICLES, SPACE
from engine.state.particles import Arrays

FIELDS = ("x", "v", "mass", "j", "E", "damage_root", "plastic_dilation", "body")
"""Fields of the particles that a snapshot is computed from."""


def snapshot(state: Arrays, rho0: Scalars, attributes: Attributes, dtype: DTypeLike = np.float64) -> xr.Dataset:
    """Return the variables of engine/quantities.PARTICLES, dimensions `particle` and `space`; no packing of rock alone.

    Args:
        state: the fields `FIELDS` of every particle.
        rho0: reference density of every particle [kg/m^3], shape [particle_count].
        attributes: global attributes, `time` [s] and `spacing` [m] among them.
        dtype: precision of all variables but `body`.
    """
    J = 1.0 + state["j"]
    values = {
        "position": state["x"],
        "velocity": state["v"],
        "mass": state["mass"],
        "J": J,
        "rho": rho0 / J,
        "damage": state["damage_root"] ** 3,
        "energy": state["E"],
    }
    if state["plastic_dilation"].any():
        values["packing"] = 1.0 + state["plastic_dilation"]
    variables = {name: _variable(name, value.astype(dtype)) for name, value in values.items()}
    variables["body"] = _variable("body", state["body"])
    return xr.Dataset(variables, {"space": list(SPACE)}, {"Conventions": "CF-1.11", **attributes})


def _variable(name: str, values: NDArray[np.generic]) -> xr.Variable:
    quantity = PARTICLES[name]
    return xr.Variable(quantity.dims("particle"), values, quantity.attributes())
