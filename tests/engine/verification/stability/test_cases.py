"""The matrix of stiff and extreme cases, and the table that the page shows of it."""

from engine.verification.stability.cases import all_cases
from engine.verification.stability.outcome import STABLE, STOPPED
from tests.helpers.stability_cases import BY_NAME, recorded

CASES = all_cases()


def test_there_are_many_cases_and_each_has_a_name_of_its_own() -> None:
    assert len(CASES) >= 60
    assert len(BY_NAME) == len(CASES)


def test_the_committed_table_is_fresh_of_exactly_the_cases_in_the_code_and_none_of_them_failed() -> None:
    """A check of the file, not of the engine: whoever adds, renames or removes a case must run the matrix anew."""
    table = recorded()
    assert list(table.index) == list(BY_NAME)
    assert set(table["verdict"]) == {STABLE, STOPPED}
    assert (table["verdict"][table["physical"] == 1] == STABLE).all()
    assert list(table["physical"]) == [int(case.physical) for case in CASES]
