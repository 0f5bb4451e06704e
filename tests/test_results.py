"""The committed results are those of a full run, and the README says what they say."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from fracparticles.claims import Status, read_claims
from fracparticles.ledger import read_ledger, summary_line
from fracparticles.plan import read_config

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = [
    ROOT / f"report/printed/{name}.yaml"
    for name in ("lucchesi2020", "lewandowski2005", "ghorbani", "particle_note")
]
STUDY = read_config(yaml.safe_load((ROOT / "config/study.yaml").read_text()))


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
    items = [item for scene in STUDY.scenes.values() for item in scene.items]
    assert len(items) == len(set(items))
    printed = {claim.item for claim in read_claims(*DOCUMENTS)}
    assert set(items) == printed


def test_every_scene_has_its_table_and_figure():
    for name, scene in STUDY.scenes.items():
        assert (ROOT / f"results/tables/{name}.csv").exists()
        assert (ROOT / f"results/tables/{name}.md").exists()
        assert (ROOT / f"report/captions/{name}.md").exists()
        for suffix in ("svg", "png"):
            assert (ROOT / f"results/figures/{name}.{suffix}").exists() == (
                scene.figure is not None
            )


def test_the_readme_and_the_report_quote_the_ledger(ledger):
    line = summary_line(ledger)
    assert line in (ROOT / "README.md").read_text()
    assert line in (ROOT / "report/report.md").read_text()
    assert line in (ROOT / "results/claims.md").read_text()
