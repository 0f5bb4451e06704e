"""Faults: nothing silent, nothing failed, every one of the counts complete."""

from __future__ import annotations

PARAMETERS = {"kills": 1, "interrupts": 1, "flips": 3, "parts": 2, "seed": 7, "workflow": False}


def test_no_probe_is_bad(bad):
    assert bad == ""


def test_all_of_a_count_went_well(table):
    counts = table[table["verdict"] == "held"]["found"].str.fullmatch(r"(\d+) of \1")
    assert counts.all()
    assert len(counts) > 15


def test_what_holds_no_run_is_refused(table):
    cases = table[table["verdict"] == "refused"]["case"].tolist()
    for damage in ("empty", "text", "zeros", "half of it zero"):
        assert {f"{damage}, read", f"{damage}, as initial data"} <= set(cases)
