"""The page of a campaign: complete in itself, and whole also where jobs are not."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from analysis.report.products import plots
from engine.job.storage import write_json
from tests.helpers.fake_campaigns import campaign, collision, grid
from tests.helpers.fake_jobs import write_job

COORDS = {"velocity": [100.0, 200.0], "angle": [5.0, 15.0]}


class Page(HTMLParser):
    """Rows of all tables, text, and addresses of a page."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self.texts: list[str] = []
        self.addresses: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.addresses += [str(value) for name, value in attrs if name in ("src", "href")]
        if tag == "tr":
            self.rows.append([])

    def handle_data(self, data):
        self.texts.append(data)
        if self.lasttag in ("td", "th") and self.rows and data.strip():
            self.rows[-1].append(data.strip())

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.texts).split())

    def row(self, first: str) -> list[str]:
        return next(row for row in self.rows if row and row[0] == first)


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    """Three of four jobs done, the last one failed."""
    campaign(tmp_path, COORDS, grid(COORDS), 3)
    write_job(tmp_path / "jobs/3", collision(), None, "failed", "dt < 1 s & <b>small</b>")
    content = json.loads((tmp_path / "campaign.json").read_text())
    write_json(tmp_path / "campaign.json", content | {"study": {"description": "Some <i>rocks</i>"}})
    session = {"arch": "cpu", "threads": 1, "git": {"commit": "abc", "dirty": True}, "packages": {"numpy": "2.0"}}
    other = session | {"threads": 2, "git": {"commit": "def"}}
    write_json(tmp_path / "jobs/0/provenance.json", {"sessions": [session, session]})
    write_json(tmp_path / "jobs/1/provenance.json", {"sessions": [other]})
    (tmp_path / "jobs/2/provenance.json").write_text("{")
    return tmp_path


def page(directory: Path) -> Page:
    plots(directory)
    return Page((directory / "report.html").read_text(encoding="utf-8"))


def test_the_page_needs_no_other_file(directory: Path) -> None:
    addresses = page(directory).addresses
    assert len(addresses) == 4
    assert all(re.match("data:image/png;base64,iVBORw0KGgo", address) for address in addresses)


def test_every_cell_has_its_row_and_every_failure_its_reason(directory: Path) -> None:
    found = page(directory)
    cells = [row for row in found.rows if row and row[-1] in ("done", "failed")]
    assert [row[:2] for row in cells] == [["100", "5"], ["100", "15"], ["200", "5"], ["200", "15"]]
    assert "3: failed: dt < 1 s & <b>small</b>" in found.text
    assert "3 done, 1 failed; 0.02 hours of processor time" in found.text


def test_texts_of_a_study_are_no_markup(directory: Path) -> None:
    assert "Some <i>rocks</i>" in page(directory).text


def test_settings_drifts_and_every_code_are_named_once(directory: Path) -> None:
    found = page(directory)
    assert found.row("particles") == ["particles", "200"]
    assert "Conventions" not in found.text
    assert found.row("change of the total mass, largest of all jobs")[1] == "1e-09"
    assert found.row("code") == ["code", "abc with changes; def"]
    assert found.row("threads") == ["threads", "1; 2"]
    assert found.row("numpy") == ["numpy", "2.0"]


def test_nothing_done_is_a_page_too(tmp_path: Path) -> None:
    assert "4 pending" in page(campaign(tmp_path, COORDS, grid(COORDS), 0)).text
