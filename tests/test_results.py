"""The committed results are those of a full run, and the README says what they say."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
import yaml

from fracstudy.claims import Status, read_claims
from fracstudy.config import read_config
from fracstudy.ledger import read_ledger, summary_line

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = [
    ROOT / f"report/printed/{name}.yaml"
    for name in ("lucchesi2020", "lewandowski2005", "ghorbani", "particle_note")
]
CONFIG = yaml.safe_load((ROOT / "config/study.yaml").read_text())
SCENES = read_config(CONFIG | {"scenes_dir": str(ROOT / "workflow/scenes"), "grids": None})[1]


@pytest.fixture(scope="module")
def ledger():
    return read_ledger(ROOT / "results/claims.csv")


def test_every_printed_claim_has_its_row(ledger):
    printed = [claim.id for claim in read_claims(*DOCUMENTS)]
    assert list(ledger["id"]) == printed


def test_a_deviation_has_a_reason_of_its_own(ledger):
    exceptions = ledger[[Status(word).needs_reason for word in ledger["status"]]]
    assert len(exceptions)
    assert (exceptions["reason"].str.len() > 20).all()
    assert not exceptions["reason"].str.contains("smoke").any()


def test_a_claim_is_judged_by_one_scene_only():
    items = [item for scene in SCENES.values() for item in scene.items]
    assert len(items) == len(set(items))
    printed = {claim.item for claim in read_claims(*DOCUMENTS)}
    assert set(items) == printed


def test_every_scene_has_its_table_and_figure():
    for name, scene in SCENES.items():
        assert (ROOT / f"results/tables/{name}.csv").exists()
        assert (ROOT / f"results/tables/{name}.md").exists()
        for suffix in ("svg", "png"):
            assert (ROOT / f"results/figures/{name}.{suffix}").exists() == (
                scene.file("figure.py") is not None
            )


def test_the_readme_and_the_report_quote_the_ledger(ledger):
    line = summary_line(ledger)
    assert line in (ROOT / "README.md").read_text()
    assert line in (ROOT / "report/report.md").read_text()
    assert line in (ROOT / "results/claims.md").read_text()


# --- tables that are tables --------------------------------------------------------------------------------------


def markdown_tables(text: str) -> list[list[int]]:
    """The number of cells of each row, table by table; a bar that is escaped is none, nor one in prose."""
    tables, rows = [], []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|") and line.rstrip().endswith("|"):
            rows.append(len(re.split(r"(?<!\\)\|", line.rstrip())) - 2)
        elif rows:
            tables.append(rows)
            rows = []
    return tables


def tracked_markdown() -> list[Path]:
    return sorted(
        path
        for folder in ("", "config", "results", "results/tables", "report", "workflow/scenes/*/*")
        for path in ROOT.glob(f"{folder}/*.md" if folder else "*.md")
    )


@pytest.mark.parametrize("path", tracked_markdown(), ids=lambda path: str(path.relative_to(ROOT)))
def test_every_row_of_a_markdown_table_has_the_cells_of_its_header(path):
    for rows in markdown_tables(path.read_text("utf-8")):
        assert len(rows) >= 2
        assert set(rows) == {rows[0]}


class Tables(HTMLParser):
    """The number of cells of each row of each table."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: list[list[int]] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append(0)
        elif tag in ("th", "td"):
            self.tables[-1][-1] += 1


def test_every_table_of_the_report_is_one_in_its_page():
    page = Tables((ROOT / "report/report.html").read_text("utf-8"))
    text = markdown_tables((ROOT / "report/report.md").read_text("utf-8"))
    assert len(page.tables) == len(text)
    # The rule below the header is no row of the page.
    for shown, rows in zip(page.tables, text, strict=True):
        assert shown == [rows[0], *rows[2:]]


def test_the_tables_of_the_report_are_those_of_the_results():
    text = (ROOT / "report/report.md").read_text("utf-8")
    for name in SCENES:
        assert (ROOT / f"results/tables/{name}.md").read_text("utf-8").strip() in text, name
