import errno
import fcntl
import json
import multiprocessing
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from engine.errors import JobError, UnavailableError
from engine.job.storage import (
    is_finite,
    read_dataset,
    remove_partial_files,
    write_atomically,
    write_dataset,
    write_json,
)
from tests.helpers.jobs import BAD_DISK


def dataset(count: int = 50) -> xr.Dataset:
    generator = np.random.default_rng(1)
    return xr.Dataset(
        {"x": (("particle", "space"), generator.normal(size=(count, 3))), "body": ("particle", np.arange(count))},
        attrs={"time": 1.5, "note": "text"},
    )


@pytest.mark.parametrize("damage", [Path.unlink, lambda path: path.write_bytes(path.read_bytes()[:1000])])
def test_a_missing_or_damaged_file_is_told_from_one_that_cannot_be_read_now(tmp_path: Path, damage) -> None:
    path = tmp_path / "data.nc"
    write_dataset(path, dataset())
    damage(path)
    with pytest.raises(JobError) as raised:
        read_dataset(path)
    assert not isinstance(raised.value, UnavailableError)
    path.unlink(missing_ok=True)
    path.symlink_to(BAD_DISK)
    with pytest.raises(UnavailableError, match=r"data\.nc: Input/output error: cannot be read now; it is kept"):
        read_dataset(path)


@pytest.mark.parametrize("code", [errno.EACCES, errno.ESTALE, errno.EMFILE, errno.ENOLCK])
def test_whatever_the_system_refuses_is_unavailable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int) -> None:
    def refuse(*arguments: object, **named: object) -> None:
        raise OSError(code, os.strerror(code))

    path = tmp_path / "data.nc"
    write_dataset(path, dataset())
    monkeypatch.setattr(xr, "open_dataset", refuse)
    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(UnavailableError, match=os.strerror(code)):
        read_dataset(path)


def test_a_disk_that_fails_for_a_moment_costs_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where netCDF gives no reason of the system."""
    path = tmp_path / "data.nc"
    write_dataset(path, dataset())
    opened, errors = xr.open_dataset, [OSError(-101, "NetCDF: HDF error"), OSError(errno.EIO, "Input/output error")]
    for error in errors:
        answers = iter([error])

        def once(*arguments: object, answers=answers, **named: object) -> xr.Dataset:
            for failure in answers:
                raise failure
            return opened(*arguments, **named)

        monkeypatch.setattr(xr, "open_dataset", once)
        assert read_dataset(path).attrs["time"] == 1.5


def test_an_error_of_the_system_is_no_damage_though_the_bytes_can_be_read(tmp_path: Path, monkeypatch) -> None:
    def refuse(*arguments: object, **named: object) -> None:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    path = tmp_path / "data.nc"
    write_dataset(path, dataset())
    monkeypatch.setattr(xr, "open_dataset", refuse)
    with pytest.raises(UnavailableError, match="Too many open files"):
        read_dataset(path)


def test_a_file_that_another_process_has_locked_is_read(tmp_path: Path) -> None:
    """HDF5 asks for a lock, which a network mount may refuse; files are replaced as a whole, so none is needed."""
    path = tmp_path / "data.nc"
    write_dataset(path, dataset())
    code = "import sys; from pathlib import Path; from engine.job.storage import read_dataset as read; "
    environment = {name: value for name, value in os.environ.items() if name != "HDF5_USE_FILE_LOCKING"}
    with path.open("rb") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        command = [sys.executable, "-c", code + "print(read(Path(sys.argv[1])).time)", str(path)]
        told = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    assert told.stdout.strip() == "1.5"


def failing(error: Exception):
    def write(partial: Path) -> None:
        partial.write_text("half")
        raise error

    return write


@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "No space left on device"), RuntimeError("NetCDF: HDF error")])
def test_a_full_disk_is_named_whatever_netcdf_calls_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
):
    monkeypatch.setattr("shutil.disk_usage", lambda path: SimpleNamespace(free=100))
    with pytest.raises(OSError, match="the disk is full: free some space") as raised:
        write_atomically(tmp_path / "file", failing(error))
    assert raised.value.errno == errno.ENOSPC and raised.value.filename == str(tmp_path / "file")
    assert not list(tmp_path.iterdir())


def test_other_trouble_keeps_its_name(tmp_path: Path):
    with pytest.raises(OSError, match="cannot be written: NetCDF: HDF error") as raised:
        write_atomically(tmp_path / "file", failing(RuntimeError("NetCDF: HDF error")))
    assert raised.value.filename == str(tmp_path / "file")
    with pytest.raises(PermissionError):
        write_atomically(tmp_path / "file", failing(PermissionError(errno.EACCES, "not yours")))


def test_what_killed_writers_left_is_removed_and_nothing_else(tmp_path: Path):
    for name in (".final.nc.77.partial", "final.nc", "notes.partial"):
        (tmp_path / name).write_text("x")
    remove_partial_files(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"final.nc", "notes.partial"}


def test_a_new_file_takes_the_place_of_the_old_one_as_a_whole(tmp_path: Path):
    path = tmp_path / "file"
    for content in ("old", "new and longer", "short"):
        write_atomically(path, lambda partial, content=content: partial.write_text(content))
        assert path.read_text() == content
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("before", [None, "old"])
def test_a_writer_that_raises_leaves_everything_as_it_was(tmp_path: Path, before: str | None):
    path = tmp_path / "file"
    if before is not None:
        path.write_text(before)

    def half(partial: Path) -> None:
        partial.write_text("half")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_atomically(path, half)
    assert list(tmp_path.iterdir()) == ([] if before is None else [path])
    assert before is None or path.read_text() == before


def die_while_writing(path: Path) -> None:
    def half(partial: Path) -> None:
        partial.write_text("half")
        os.kill(os.getpid(), signal.SIGKILL)

    write_atomically(path, half)


def test_a_killed_writer_leaves_no_file_under_the_final_name(tmp_path: Path):
    path = tmp_path / "final.nc"
    writer = multiprocessing.get_context("spawn").Process(target=die_while_writing, args=(path,))
    writer.start()
    writer.join()
    assert writer.exitcode == -signal.SIGKILL
    assert not path.exists()
    # what it leaves carries another name, and nothing that looks for results would take it for one
    assert all(re.fullmatch(r"\..*\.partial", left.name) for left in tmp_path.iterdir())


def test_json_is_whole_and_sorted(tmp_path: Path):
    write_json(tmp_path / "status.json", {"b": 1, "a": [1.5, "x"]})
    text = (tmp_path / "status.json").read_text()
    assert json.loads(text) == {"a": [1.5, "x"], "b": 1}
    assert text.index('"a"') < text.index('"b"')


def test_json_that_cannot_be_written_leaves_the_old_file(tmp_path: Path):
    path = tmp_path / "status.json"
    write_json(path, {"a": 1})
    with pytest.raises(TypeError):
        write_json(path, {"a": object()})
    assert json.loads(path.read_text()) == {"a": 1}


def test_a_dataset_is_read_as_it_was_written(tmp_path: Path):
    write_dataset(tmp_path / "data.nc", dataset())
    found = read_dataset(tmp_path / "data.nc")
    xr.testing.assert_identical(found, dataset())
    assert found["x"].values.tobytes() == dataset()["x"].values.tobytes()


def test_equal_datasets_make_equal_files(tmp_path: Path):
    for name in ("one.nc", "other.nc"):
        write_dataset(tmp_path / name, dataset())
    assert (tmp_path / "one.nc").read_bytes() == (tmp_path / "other.nc").read_bytes()


@pytest.mark.parametrize("share", [0.0, 0.001, 0.1, 0.5, 0.9, 0.99])
def test_a_netcdf_file_that_was_cut_off_is_an_error(tmp_path: Path, share: float):
    path = tmp_path / "data.nc"
    write_dataset(path, dataset(2000))
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(JobError, match=r"data\.nc: cannot be read"):
        read_dataset(path)


@pytest.mark.parametrize("content", [None, b"", b"text", b"\x89HDF\r\n\x1a\n" + bytes(200)])
def test_a_missing_or_foreign_file_is_an_error(tmp_path: Path, content: bytes | None):
    path = tmp_path / "data.nc"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(JobError, match=r"data\.nc"):
        read_dataset(path)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_only_finite_numbers_are_finite(bad: float):
    data = dataset()
    assert is_finite(data)
    data["x"][7, 1] = bad
    assert not is_finite(data)
