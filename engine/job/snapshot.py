"""The particles of one moment as a data set."""

from typing import Any

import numpy as np
import xarray as xr

from engine.job.history import SPACE
from engine.state.particles import Arrays

ATTRIBUTES = {
    "position": ("position", "m"),
    "velocity": ("velocity", "m s-1"),
    "mass": ("mass", "kg"),
    "J": ("volume relative to the reference state, det F", "1"),
    "rho": ("density", "kg m-3"),
    "damage": ("damage", "1"),
    "energy": ("specific internal energy", "J kg-1"),
    "body": ("index of the body the particle came from", "1"),
}

FIELDS = ("x", "v", "mass", "j", "E", "root", "body")
"""Particle fields that a snapshot is made of."""


def snapshot(state: Arrays, rho0: Any, attributes: dict[str, Any], dtype: type = np.float64) -> xr.Dataset:
    """Particles as they are now.

    Args:
        state: the fields `FIELDS`.
        rho0: reference density of every particle [kg/m^3], shape [particle_count].
        attributes: what to say of the whole, among it `time` [s] and `spacing` [m].
        dtype: precision on disk.
    """
    J = 1.0 + state["j"]
    values = {
        "position": state["x"],
        "velocity": state["v"],
        "mass": state["mass"],
        "J": J,
        "rho": rho0 / J,
        "damage": state["root"] ** 3,
        "energy": state["E"],
    }
    variables = {name: _variable(name, value.astype(dtype)) for name, value in values.items()}
    variables["body"] = _variable("body", state["body"])
    return xr.Dataset(variables, {"space": SPACE}, {"Conventions": "CF-1.11", **attributes})


def _variable(name: str, values: Any) -> xr.Variable:
    long_name, units = ATTRIBUTES[name]
    return xr.Variable(("particle", "space")[: values.ndim], values, {"long_name": long_name, "units": units})
