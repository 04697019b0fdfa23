"""Tables, figures and the command line, for every layout a study can have."""

from pathlib import Path
from typing import Any

import matplotlib.image
import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from analysis.cli import app, main
from analysis.remnant.fragments import OTHER_LENGTHS, friends_of_friends
from analysis.report.products import plots
from analysis.results.collect import collect
from analysis.results.tables import printed, reasons, series, shape_table
from engine.job.storage import write_dataset
from engine.scene.scene import scene_in
from tests.helpers.fake_campaigns import campaign, collision, grid
from tests.helpers.fake_jobs import lattice_ellipsoid, particles, write_campaign, write_job

FIGURES = ("shape_vs_angle", "maps", "remnants", "conservation")


LAYOUTS: dict[str, tuple[dict[str, list[Any]], int]] = {
    "grid": ({"velocity": [100.0, 200.0], "angle": [5.0, 15.0, 25.0]}, 4),
    "one angle": ({"velocity": [100.0, 200.0], "angle": [5.0]}, 2),
    "seeds": ({"angle": [5.0, 15.0], "seed": [1, 2]}, 4),
    "another axis": ({"viscosity.shear": [0.0, 1e5]}, 2),
    "nothing done": ({"velocity": [100.0], "angle": [5.0, 15.0]}, 0),
}


def check_figures(directory: Path) -> None:
    """Every figure is a picture that can be opened; tests/analysis/report/figures tells what is on it."""
    for name in FIGURES:
        image = matplotlib.image.imread(directory / f"figures/{name}.png")
        assert image.shape[0] > 150 and image.shape[1] > 300, name
        assert image[..., :3].std() > 0.01, name


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_layout_has_its_table_and_figures(tmp_path: Path, layout: str) -> None:
    coords, done = LAYOUTS[layout]
    cells = grid(coords)
    results, written = plots(campaign(tmp_path, coords, cells, done))
    names = {"shape_table.csv", "report.html", *(f"{name}.png" for name in FIGURES)}
    assert {path.name for path in written} == names
    check_figures(tmp_path)
    table = pd.read_csv(tmp_path / "shape_table.csv")
    assert len(table) == len(cells) and table["b_over_a"].notna().sum() == done
    assert len(printed(shape_table(results)).splitlines()) == len(cells) + 1


def test_clumps_of_a_state_are_sought_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counts: dict[float, int] = {}

    def counted(position: np.ndarray, mass: np.ndarray, length: float) -> np.ndarray:
        counts[length] = counts.get(length, 0) + 1
        return friends_of_friends(position, mass, length)

    monkeypatch.setattr("analysis.remnant.fragments.friends_of_friends", counted)
    coords, done = LAYOUTS["grid"]
    plots(campaign(tmp_path, coords, grid(coords), done))
    assert sum(counts.values()) == (1 + len(OTHER_LENGTHS)) * done


def test_cases_have_a_row_each_and_figures(tmp_path: Path) -> None:
    jobs = [("a", collision(angle=5.0)), ("b", collision(angle=15.0)), ("c", collision(velocity=300.0, angle=25.0))]
    write_campaign(tmp_path, {"case": ["a", "b", "c"]}, [({"case": name}, case) for name, case in jobs])
    points, spacing = lattice_ellipsoid((2e5, 1e5, 8e4), 150)
    for number in (0, 2):
        write_job(tmp_path / f"jobs/{number}", jobs[number][1], particles(points, spacing, time=900.0))
    results, _ = plots(tmp_path)
    check_figures(tmp_path)
    table = shape_table(results)
    assert table["case"].tolist() == ["a", "b", "c"] and table["velocity"].tolist() == [200.0, 200.0, 300.0]


def test_the_printed_table_shows_a_dash_for_what_is_not_there(tmp_path: Path) -> None:
    coords = {"velocity": [100.0], "angle": [5.0, 15.0]}
    lines = printed(shape_table(collect(campaign(tmp_path, coords, grid(coords), 1)))).splitlines()
    assert "M_lr/M_t" in lines[0] and "nan" not in "".join(lines).lower()
    assert lines[1].split()[-1] == "done"
    assert lines[2].split()[2:-1] == ["-"] * 12 and lines[2].split()[-1] == "pending"


def test_series_are_told_apart_by_everything_but_velocity_angle_and_seed(tmp_path: Path) -> None:
    coords = {"velocity": [100.0, 200.0], "viscosity.shear": [0.0, 1e5], "seed": [1, 2]}
    groups = list(series(collect(campaign(tmp_path, coords, grid(coords), 0))))
    assert [name for name, _ in groups] == ["viscosity.shear 0", "viscosity.shear 100000"]
    assert [len(rows) for _, rows in groups] == [4, 4]


def test_an_axis_of_end_times_is_a_series_and_the_times_of_cases_are_not(tmp_path: Path) -> None:
    coords = {"velocity": [200.0], "angle": [5.0, 15.0], "end_time": [500.0, 1000.0]}
    groups = list(series(collect(campaign(tmp_path, coords, grid(coords), 0))))
    assert [name for name, _ in groups] == ["end_time 500", "end_time 1000"]
    cases = [("a", collision(angle=5.0)), ("b", collision(angle=15.0, end_time=500.0))]
    write_campaign(tmp_path, {"case": ["a", "b"]}, [({"case": name}, case) for name, case in cases])
    assert len(list(series(collect(tmp_path)))) == 1


def test_reasons_name_the_job(tmp_path: Path) -> None:
    coords = {"velocity": [100.0], "angle": [5.0, 15.0]}
    campaign(tmp_path, coords, grid(coords), 1)
    write_job(tmp_path / "jobs/1", collision(), None, "failed", "dt too small")
    assert reasons(collect(tmp_path)) == ["1: failed: dt too small"]


def test_the_command_line_prints_the_table_and_says_when_nothing_is_done(tmp_path: Path) -> None:
    coords = {"velocity": [100.0], "angle": [5.0]}
    told = CliRunner().invoke(app, ["plots", str(campaign(tmp_path, coords, grid(coords), 0))])
    assert told.exit_code == 0
    assert "pending" in told.output and "no job of this campaign is done yet" in told.output


def test_the_command_line_prints_one_remnant_even_before_it_is_done(tmp_path: Path) -> None:
    coords = {"velocity": [100.0], "angle": [5.0]}
    job = campaign(tmp_path, coords, grid(coords), 1) / "jobs/0"
    told = CliRunner().invoke(app, ["remnant", str(job)])
    assert told.exit_code == 0 and "b_over_a" in told.output and "not done" not in told.output
    (job / "final.nc").unlink()
    (job / "snapshots").mkdir()
    points, spacing = lattice_ellipsoid((2e5, 1e5, 8e4), 150)
    for time in (300.0, 400.0):
        snapshot = particles(points, spacing, time=time, scene_hash=scene_in(job).hash())
        write_dataset(job / f"snapshots/{time:.3f}.nc", snapshot)
    told = CliRunner().invoke(app, ["remnant", str(job)])
    assert "not done: last snapshot, 400 s after contact" in told.output


@pytest.mark.parametrize("command", ["plots", "remnant"])
def test_errors_are_one_plain_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    monkeypatch.setattr("sys.argv", ["analysis", command, str(tmp_path / "nowhere")])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1 and "nowhere" in told
