"""Rough and extreme data: right, spoken of, or refused."""

from __future__ import annotations

PARAMETERS = {"beta": 0.5, "schemes": ["DD", "KPSE", "GPSE"], "dims": [1, 2], "half_width": 12.0}


def test_every_probe_holds_or_is_spoken_of(bad):
    assert bad == ""


def test_the_discrete_problem_is_solved_whatever_the_data(table):
    for kind in ("exact", "sum of data", "mirror", "shift", "units", "bounds", "total", "sign"):
        assert set(table[table["kind"] == kind]["verdict"]) == {"held"}, kind


def test_what_means_nothing_is_refused_and_what_is_rough_is_spoken_of(table):
    assert set(table[table["kind"] == "refused"]["verdict"]) == {"refused"}
    assert set(table[table["kind"] == "wave of two"]["verdict"]) == {"warned"}
    hidden = table[table["case"].str.contains("between two")]
    assert set(hidden["verdict"]) == {"warned"}


def test_half_of_the_probes_have_a_source(table):
    assert (table["source"] != "").mean() > 0.5
