"""The page of names is true: what it says where to find is there."""

import re

import pytest

from tests.system.test_rooms import ROOT

PAGE = (ROOT / "docs" / "names.md").read_text()
SYMBOLS = [line.split("|") for line in PAGE.splitlines() if re.match(r"\| `", line) and line.count("|") == 5]


def sources(where: str) -> str:
    """Text of the files that an entry of the last column names, files or folders apart by commas."""
    if where == "everywhere":
        return "".join(path.read_text() for path in ROOT.glob("engine/**/*.py"))
    paths = [ROOT / where, ROOT / "engine" / where]
    (path,) = [path for path in paths if path.exists()]
    return "".join(file.read_text() for file in ([path] if path.is_file() else path.rglob("*.py")))


@pytest.mark.parametrize("row", SYMBOLS, ids=lambda row: row[1].strip())
def test_each_symbol_is_used_where_the_page_says(row):
    symbols = re.findall(r"`([^`]+)`", row[1])
    texts = [sources(where.strip()) for where in row[4].split(",")]
    for symbol in symbols:
        assert any(re.search(rf"\b{re.escape(symbol)}\b", text) for text in texts), symbol
