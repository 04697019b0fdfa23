"""The history of a run: its conserved quantities at regular times, as a data set that grows by rows."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from engine.job.storage import Attributes
from engine.quantities import HISTORY, SPACE
from engine.simulation.conservation import Row


class History:
    """Rows of one run, oldest first."""

    def __init__(self, rows: list[Row] | None = None) -> None:
        self.rows = rows or []

    def append(self, row: Row) -> None:
        """Add the newest row."""
        self.rows.append(row)

    def dataset(self, attributes: Attributes) -> xr.Dataset:
        """All rows with CF attributes, dimension time."""
        variables = {name: _variable(name, [row[name] for row in self.rows]) for name in self.rows[0] if name != "time"}
        time = xr.Variable("time", np.array([float(row["time"]) for row in self.rows]), HISTORY["time"].attributes())
        return xr.Dataset(variables, {"time": time, "space": list(SPACE)}, {"Conventions": "CF-1.11", **attributes})

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset) -> "History":
        """The history that `dataset` was made of."""
        names = [*dataset.data_vars, "time"]
        return cls([{str(n): dataset[n].values[i] for n in names} for i in range(dataset.sizes["time"])])


def _variable(name: str, values: list[NDArray[np.float64]]) -> xr.Variable:
    quantity = HISTORY[name]
    return xr.Variable(quantity.dims("time"), np.stack(values), quantity.attributes())
