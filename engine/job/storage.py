"""Atomic writing of files: under another name, flushed to disk, then renamed."""

import errno
import json
import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import xarray as xr

from engine.errors import JobError, UnavailableError, in_words

Content = TypeVar("Content")

Attributes = Mapping[str, str | int | float]
"""Global attributes of a data set."""

os.environ.setdefault("HDF5_USE_FILE_LOCKING", "FALSE")  # files are replaced as a whole; network mounts refuse locks

NO_FILE = (FileNotFoundError, IsADirectoryError, NotADirectoryError)
"""Errors of the system where there is no file to wait for."""

UNREAD = (OSError, ValueError, KeyError, RuntimeError)
"""Errors of netCDF and xarray where a file is damaged or cannot be read."""

PIECE = 1 << 20
"""Bytes that are read at once."""

FULL = 1 << 20
"""Free space [bytes] below which a disk counts as full."""


def write_atomically(path: Path, write: Callable[[Path], None]) -> None:
    """Write a file completely or not at all.

    Args:
        path: the file; on failure it stays as it was.
        write: writes the content to the path it is given.

    Raises:
        OSError: the file cannot be written; names it and the cause.
    """
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        write(partial)
        with partial.open("rb") as stream:
            os.fsync(stream.fileno())
        partial.replace(path)
    except (OSError, RuntimeError) as error:  # the latter is netCDF's word for any trouble with a disk
        raise _cause(error, path) from error
    finally:
        partial.unlink(missing_ok=True)


def _cause(error: OSError | RuntimeError, path: Path) -> OSError:
    """Why a file could not be written; netCDF reports a full disk in many ways."""
    code = error.errno if isinstance(error, OSError) and error.errno else errno.EIO
    if code == errno.ENOSPC or shutil.disk_usage(path.parent).free < FULL:
        return OSError(errno.ENOSPC, "cannot be written, the disk is full: free some space", str(path))
    return OSError(code, f"cannot be written: {getattr(error, 'strerror', None) or error}", str(path))


def remove_partial_files(directory: Path) -> None:
    """Remove the files that killed processes left half written; no other process may be writing there."""
    for partial in directory.glob(".*.partial"):
        partial.unlink(missing_ok=True)


def write_json(path: Path, content: Mapping[str, object]) -> None:
    """Write indented JSON.

    Raises:
        OSError: the file cannot be written.
    """
    write_text(path, json.dumps(content, indent=1, sort_keys=True) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write a text in UTF-8.

    Raises:
        OSError: the file cannot be written.
    """
    write_atomically(path, lambda partial: _fill(partial, text))


def _fill(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def write_dataset(path: Path, dataset: xr.Dataset) -> None:
    """Write a data set as netCDF-4.

    Raises:
        OSError: the file cannot be written.
    """
    write_atomically(path, lambda partial: dataset.to_netcdf(partial, engine="netcdf4"))


def read_dataset(path: Path) -> xr.Dataset:
    """Read a whole data set into memory.

    Raises:
        UnavailableError: the system refuses to read it now.
        JobError: the file is missing or not a complete netCDF file.
    """
    return _read(path, xr.Dataset.load)


def read_if_sound(path: Path) -> xr.Dataset | None:
    """Read a whole data set into memory; `None` where the file is missing or damaged.

    Raises:
        UnavailableError: the system refuses to read it now; what it contains must not count as lost.
    """
    try:
        return read_dataset(path)
    except UnavailableError:
        raise
    except JobError:
        return None


def read_attributes(path: Path) -> dict[str, Any]:
    """Read the global attributes of a data set.

    Raises:
        UnavailableError, JobError: as `read_dataset`.
    """
    return _read(path, lambda dataset: dict(dataset.attrs))


def _read(path: Path, take: Callable[[xr.Dataset], Content]) -> Content:
    """What `take` returns of a data set that is open."""
    with suppress(*UNREAD):  # a second time: the disk may have failed for a moment
        return _taken(path, take)
    try:
        return _taken(path, take)
    except UNREAD as error:
        _require_available(path, error)
        raise JobError(f"{path}: cannot be read as netCDF: {error}") from error


def _taken(path: Path, take: Callable[[xr.Dataset], Content]) -> Content:
    with xr.open_dataset(path, engine="netcdf4", decode_timedelta=False) as dataset:
        return take(dataset)


def _require_available(path: Path, error: Exception) -> None:
    """Tell a file that the system refuses to read from a damaged one, which netCDF does not: read all its bytes.

    netCDF's own numbers of errors are negative, or EINVAL.
    """
    with read_or_unavailable(path), suppress(*NO_FILE):
        if isinstance(error, OSError) and (error.errno or 0) > 0 and error.errno != errno.EINVAL:
            raise error
        with path.open("rb") as stream:
            while stream.read(PIECE):
                pass


@contextmanager
def read_or_unavailable(path: Path) -> Iterator[None]:
    """Say of an error of the system in the `with` block that the file cannot be read now.

    Raises:
        UnavailableError: instead of any `OSError` but those of `NO_FILE`.
    """
    try:
        yield
    except NO_FILE:
        raise
    except OSError as error:
        raise UnavailableError(f"{in_words(error, path)}: cannot be read now; it is kept: try again later") from error


def is_finite(dataset: xr.Dataset) -> bool:
    """Whether every floating-point number in the data set is finite."""
    floats = (v for v in dataset.data_vars.values() if np.issubdtype(v.dtype, np.floating))
    return all(bool(np.isfinite(variable).all()) for variable in floats)
