"""The history of a run: its conserved quantities at regular times, as a data set that grows by rows."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from engine.simulation.conservation import Row

ATTRIBUTES = {
    "time": ("time after point-mass contact", "s"),
    "step": ("time steps done", "1"),
    "dt": ("time step", "s"),
    "mass": ("total mass", "kg"),
    "momentum": ("total momentum", "kg m s-1"),
    "angular_momentum": ("total angular momentum about the origin, affine part included", "kg m2 s-1"),
    "kinetic_energy": ("kinetic energy of the mean motion of particles", "J"),
    "affine_kinetic_energy": ("kinetic energy of the motion inside particles", "J"),
    "internal_energy": ("work done by stress, elastic energy included", "J"),
    "elastic_energy": ("energy stored in elastic strain, a part of internal_energy", "J"),
    "gravitational_energy": ("gravitational energy", "J"),
    "half_step_work": ("work in half a step: takes kinetic energy to the time of the other energies", "J"),
    "total_energy": ("kinetic, affine, internal and gravitational energy; what is lost is numerical dissipation", "J"),
    "gravity_change": ("relative change of gravity over the interval for which it was held", "1"),
    "gravity_force": ("net force of gravity, which is taken out, over the sum of all forces", "1"),
    "gravity_torque": ("net torque of gravity, which is taken out, over the sum of forces times distances", "1"),
    "largest_speed": ("highest speed of a particle", "m s-1"),
    "largest_compression": ("highest rho/rho0 of a particle", "1"),
    "damaged_fraction": ("mean damage of all particles", "1"),
    "isolated": ("particles that share no block with another", "1"),
}
SPACE = ["x", "y", "z"]


class History:
    """Rows of one run, oldest first."""

    def __init__(self, rows: list[Row] | None = None) -> None:
        self.rows = rows or []

    def append(self, row: Row) -> None:
        """Add the newest row."""
        self.rows.append(row)

    def dataset(self, attributes: dict[str, Any]) -> xr.Dataset:
        """All rows with CF attributes, dimension time."""
        variables = {name: _variable(name, [row[name] for row in self.rows]) for name in self.rows[0] if name != "time"}
        time = xr.Variable("time", np.array([float(row["time"]) for row in self.rows]), _attributes("time"))
        return xr.Dataset(variables, {"time": time, "space": SPACE}, {"Conventions": "CF-1.11", **attributes})

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset) -> "History":
        """The history that `dataset` was made of."""
        names = [*dataset.data_vars, "time"]
        return cls([{str(n): dataset[n].values[i] for n in names} for i in range(dataset.sizes["time"])])


def _variable(name: str, values: list[NDArray[np.float64]]) -> xr.Variable:
    stacked = np.stack(values)
    return xr.Variable(("time", "space")[: stacked.ndim], stacked, _attributes(name))


def _attributes(name: str) -> dict[str, str]:
    long_name, units = ATTRIBUTES[name]
    return {"long_name": long_name, "units": units}
