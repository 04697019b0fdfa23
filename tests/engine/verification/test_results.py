"""The table of results and its file."""

from math import inf
from pathlib import Path

import pandas as pd

from engine.verification import results
from engine.verification.catalogue import FULL
from engine.verification.check import Check
from engine.verification.results import Result, write_table

RECORDED = Path(results.__file__).with_name("results.csv")


def test_the_page_s_table_has_every_scene_in_the_order_of_the_catalogue_and_none_failed():
    table = pd.read_csv(RECORDED)
    assert list(dict.fromkeys(table["scene"])) == list(FULL)
    assert table["passed"].all()


def test_rows_of_problems_that_did_not_run_stay_to_the_last_digit(tmp_path):
    path = tmp_path / "results.csv"
    path.write_bytes(RECORDED.read_bytes())
    write_table(path, [], list(FULL))
    assert path.read_bytes() == RECORDED.read_bytes()


def test_rows_of_a_problem_that_ran_are_replaced_in_their_order(tmp_path):
    path, order = tmp_path / "results.csv", ["a", "b", "c"]
    check = Check("x", "m", 1.0, 2.0, 1.0, inf)
    write_table(path, [Result("a", [check, check], 1.0), Result("c", [check], 1.0)], order)
    write_table(path, [Result("b", [check], 2.0), Result("a", [check], 3.0)], order)
    table = pd.read_csv(path)
    assert list(zip(table["scene"], table["wall_time"], strict=True)) == [("a", 3.0), ("b", 2.0), ("c", 1.0)]


def test_a_problem_that_broke_off_has_no_rows_but_a_line_on_the_screen(tmp_path):
    path = tmp_path / "results.csv"
    broken = Result("a", [], 1.0, "speed is too high")
    write_table(path, [Result("a", [Check("x", "m", 1.0, 1.0, 0.0, 1.0)], 1.0)], ["a"])
    write_table(path, [broken], ["a"])
    assert len(pd.read_csv(path)) == 0 and not broken.passed
    assert results.table([broken]).row_count == 1
