"""Files that are either whole or absent: written under another name, flushed to disk, then renamed."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from engine.errors import JobError


def write_atomically(path: Path, write: Callable[[Path], None]) -> None:
    """Let `write` fill a neighbour of `path`, then move it there; on any failure `path` stays as it was."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        write(partial)
        with partial.open("rb") as stream:
            os.fsync(stream.fileno())
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def write_json(path: Path, content: dict[str, Any]) -> None:
    """Write `content` as indented JSON."""
    text = json.dumps(content, indent=1, sort_keys=True) + "\n"
    write_atomically(path, lambda partial: _write_text(partial, text))


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def write_dataset(path: Path, dataset: xr.Dataset) -> None:
    """Write a data set as netCDF-4; equal data sets give equal values, attributes and layout."""
    write_atomically(path, lambda partial: dataset.to_netcdf(partial, engine="netcdf4"))


def read_dataset(path: Path) -> xr.Dataset:
    """The whole data set in a file, in memory.

    Raises:
        JobError: the file is missing or not a complete netCDF file.
    """
    try:
        with xr.open_dataset(path, engine="netcdf4", decode_timedelta=False) as dataset:
            return dataset.load()
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise JobError(f"{path}: cannot be read as netCDF: {error}") from error


def is_finite(dataset: xr.Dataset) -> bool:
    """Whether every floating-point number in the data set is finite."""
    floats = (v for v in dataset.data_vars.values() if np.issubdtype(v.dtype, np.floating))
    return all(bool(np.isfinite(variable).all()) for variable in floats)
