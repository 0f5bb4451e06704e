"""The committed results are those of a full run, and the README says what they say."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path
from string import Formatter

import pandas as pd
import pytest

from fracstudy.claims import Statement, Value
from fracstudy.findings import read_findings
from fracstudy.ledger import ledger as made_ledger
from fracstudy.ledger_text import read_ledger, summary_line
from fracstudy.printed import read_claims, read_printed
from fracstudy.scene import Scene
from fracstudy.verdicts import Status
from scene_functions import configured
from sweeps import at_once

ROOT = Path(__file__).resolve().parents[1]


def scenes() -> dict[str, Scene]:
    return configured()[1]


def printed() -> list[Path]:
    return [ROOT / path for path in configured()[0].all_printed(scenes().values())]


@pytest.fixture(scope="module")
def ledger():
    return read_ledger(ROOT / "results/claims.csv")


def test_every_printed_claim_has_its_row(ledger):
    assert list(ledger["id"]) == [claim.id for claim in read_claims(*printed())]


def test_the_rows_quote_what_is_printed_and_name_what_made_the_numbers(ledger):
    columns = ["sentence", "printed", "where", "what", "made_by"]
    rows = list(ledger[columns].itertuples(index=False, name=None))
    assert rows == [
        (record.name, record.words, record.where, claim.what, "; ".join(claim.by or record.by))
        for record in read_printed(*printed())
        for claim in record.claims
    ]


def test_every_number_of_ours_says_what_made_it(ledger):
    judged = ledger[ledger["status"] != Status.NOT_TESTABLE]
    assert list(judged[(judged["runs"] == "") & (judged["made_by"] == "")]["id"]) == []


def test_every_verdict_on_a_statement_has_its_criterion(ledger):
    judged = ledger[(ledger["sentence"] != "") & (ledger["status"] != Status.NOT_TESTABLE)]
    assert (judged["criterion"] != "").all()
    assert (judged["ours"] != "").all()


def asked_for(claim: Value | Statement) -> set[str]:
    """The numbers that the criteria and the texts of a claim ask for."""
    if isinstance(claim, Value):
        names = {"ours"}
    else:
        names = {condition.of for condition in claim.holds}
        names |= {c.of for c in claim.intended.holds} if claim.intended else set()
    for field in ("reason", "note", "evidence", "untestable", "changed"):
        fields = [name for _, name, _, _ in Formatter().parse(getattr(claim, field, ""))]
        names |= {re.split(r"[.\[]", name)[0] for name in fields if name}
    return names


def findings_in(results):
    """The findings of each scene that judges claims; they are not tracked."""
    files = [ROOT / results / f"findings/{n}.json" for n, scene in scenes().items() if scene.items]
    if not all(file.exists() for file in files):
        return {}
    return {file.stem: read_findings([file]) for file in files}


@pytest.fixture(scope="module")
def findings():
    return findings_in("results") or pytest.skip("the study has not been run here")


def test_the_ledger_is_what_the_findings_give(ledger, findings):
    made = made_ledger(read_printed(*printed()), [f for found in findings.values() for f in found])
    pd.testing.assert_frame_equal(ledger, made, check_exact=False, rtol=1e-15)


def test_no_study_measures_what_none_of_its_claims_asks_for():
    """What is measured has the same names on tiny grids. Of variants, what one asks for the others may measure, too."""
    found = findings_in("results") or findings_in("results-smoke")
    if not found:
        pytest.skip("neither the study nor a smoke run has been made here")
    claims = {claim.id: claim for claim in read_claims(*printed())}
    unasked, asked = defaultdict(set), defaultdict(set)
    for scene, findings in found.items():
        study = scenes()[scene].folder.name
        unasked[study].update(name for finding in findings for name in finding.numbers)
        asked[study].update(*(asked_for(claims[finding.claim]) for finding in findings))
    assert {
        study: names - asked[study] for study, names in unasked.items() if names - asked[study]
    } == {}


def test_a_deviation_has_a_reason_of_its_own(ledger):
    exceptions = ledger[[Status(word).needs_reason for word in ledger["status"]]]
    assert len(exceptions)
    assert (exceptions["reason"].str.len() > 20).all()
    assert not exceptions["reason"].str.contains("smoke").any()


def test_a_claim_is_judged_by_one_scene_only():
    items = [item for scene in scenes().values() for item in scene.items]
    assert len(items) == len(set(items))
    assert set(items) == {claim.item for claim in read_claims(*printed())}


def test_every_scene_has_its_table_and_figure():
    for name, scene in scenes().items():
        assert (ROOT / f"results/tables/{name}.csv").exists()
        assert (ROOT / f"results/tables/{name}.md").exists()
        for suffix in ("svg", "png"):
            assert (ROOT / f"results/figures/{name}.{suffix}").exists() == (
                scene.file("figure.py") is not None
            )


def test_the_readme_and_the_report_quote_the_ledger(ledger):
    line = summary_line(ledger)
    assert line in (ROOT / "README.md").read_text()
    assert line in (ROOT / "CITATION.cff").read_text()
    assert line in (ROOT / "report/README.md").read_text()
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


@at_once(tracked_markdown())
def test_every_row_of_a_markdown_table_has_the_cells_of_its_header(path):
    for rows in markdown_tables(path.read_text("utf-8")):
        assert len(rows) >= 2
        assert set(rows) == {rows[0]}


def test_the_tables_of_the_report_are_those_of_the_results():
    for name, scene in scenes().items():
        text = (ROOT / f"report/{scene.document}.md").read_text("utf-8")
        table = (ROOT / f"results/tables/{name}.md").read_text("utf-8").strip()
        assert table in text or f"rows](../results/tables/{name}.md)" in text, name
