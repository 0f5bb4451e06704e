"""What a call of the workflow ends with."""

from __future__ import annotations

import json
from pathlib import Path

from fracstudy.ledger_text import read_ledger, summary_line
from fracstudy.summary import already, shortly, slowest, summary

ROOT = Path(__file__).resolve().parents[2]


def test_the_slowest_jobs_of_this_call_come_first(tmp_path):
    records = [("a", 100.0, 103.0), ("a", 100.0, 103.0), ("b", 100.0, 109.0), ("old", 10.0, 90.0)]
    for k, (rule, started, ended) in enumerate(records):
        record = {"rule": rule, "starttime": started, "endtime": ended}
        (tmp_path / str(k)).write_text(json.dumps(record))
    (tmp_path / "half").write_text('{"rule": "c"')
    assert slowest(tmp_path, since=99.0) == [(9.0, "b"), (3.0, "a")]
    assert slowest(tmp_path, since=99.0, count=1) == [(9.0, "b")]


def test_the_summary_says_what_came_of_it_and_where_to_look(tmp_path):
    claims = ROOT / "results/claims.csv"
    text = summary(claims, [claims, tmp_path / "gone"], [(9.0, "make_overlap")])
    assert summary_line(read_ledger(claims)) in text
    assert "overlap 9 s" in text
    assert "gone" not in text
    assert summary(tmp_path / "gone", [], []) == ""


def test_names_are_said_in_one_line():
    assert shortly("cab") == "a, b, c"
    assert shortly("fedcba") == "a, b, c, d, e, f"
    assert shortly("gfedcba") == "a, b, c, d, e and 2 more"


def test_what_is_there_already_is_counted_whole(tmp_path):
    for name in ("a.csv", "a.svg", "b.csv", "run.nc"):
        (tmp_path / name).touch()
    scenes = [[tmp_path / f"{name}.{end}" for end in ("csv", "svg")] for name in "abc"]
    said = already(tmp_path, {"runs": [[tmp_path / "run.nc"]], "scenes": scenes})
    assert said == (
        f"Already in {tmp_path}: 1 of 1 runs, 1 of 3 scenes; what is up to date is not made again."
    )
    assert "0 of 0 runs" in already(tmp_path, {"runs": []})
