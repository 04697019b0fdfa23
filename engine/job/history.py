"""History of a run: its conserved quantities at regular times."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from engine.job.storage import Attributes
from engine.quantities import HISTORY, SPACE
from engine.simulation.conservation import Row


class History:
    """History of one run.

    Args:
        rows: earlier rows.

    Attributes:
        rows: all rows, oldest first.
    """

    def __init__(self, rows: list[Row] | None = None) -> None:
        self.rows = rows or []

    def append(self, row: Row) -> None:
        """Add a row that is later than all others."""
        self.rows.append(row)

    def dataset(self, attributes: Attributes) -> xr.Dataset:
        """Return all rows as a data set with CF attributes, dimensions `time` and `space`.

        Args:
            attributes: global attributes.
        """
        variables = {name: _variable(name, [row[name] for row in self.rows]) for name in self.rows[0] if name != "time"}
        time = xr.Variable("time", np.array([float(row["time"]) for row in self.rows]), HISTORY["time"].attributes())
        return xr.Dataset(variables, {"time": time, "space": list(SPACE)}, {"Conventions": "CF-1.11", **attributes})

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset) -> "History":
        """Return the history that was written as a data set."""
        names = [*dataset.data_vars, "time"]
        return cls([{str(n): dataset[n].values[i] for n in names} for i in range(dataset.sizes["time"])])


def _variable(name: str, values: list[NDArray[np.float64]]) -> xr.Variable:
    quantity = HISTORY[name]
    return xr.Variable(quantity.dims("time"), np.stack(values), quantity.attributes())
