"""The data set, table and summary of all outcomes."""

from pathlib import Path

import pandas as pd

from engine.job.storage import read_dataset
from engine.verification.stability.outcome import FAILED, STABLE, STOPPED, Outcome
from engine.verification.stability.results import dataset, summary, write
from engine.verification.stability.von_neumann import Limit
from tests.helpers.stability_cases import CALM


def test_results_are_written_with_units_and_counted_by_group(tmp_path: Path) -> None:
    ends = [("a", "1", STABLE), ("a", "2", STOPPED), ("b", "1", FAILED)]
    outcomes = [Outcome(group, name, "f64", False, verdict, "", 5, 1.0, 0.1, CALM) for group, name, verdict in ends]
    results = dataset(outcomes, [Limit("1 x 1 x 1", 1.001, 1.0)])
    write(tmp_path, results)
    assert read_dataset(tmp_path / "stability.nc").identical(results)
    assert (tmp_path / "stability.png").stat().st_size > 0
    assert all(set(results[name].attrs) == {"long_name", "units"} for name in results.data_vars)
    table = pd.read_csv(tmp_path / "stability.csv")
    assert list(table["verdict"]) == [STABLE, STOPPED, FAILED] and (table["nearest"] == 0.5).all()
    counts = summary(results)[[STABLE, STOPPED, FAILED]]
    assert counts.loc["a"].tolist() == [1, 1, 0] and counts.loc["b"].tolist() == [0, 0, 1]
