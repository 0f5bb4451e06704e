"""Lattices that do not suit: right, spoken of, or refused."""

from __future__ import annotations

PARAMETERS = {
    "beta": 0.5,
    "sizes": {"of a few": [1, 2, 3], "prime": [151]},
    "orders": [12],
    "overlaps": [0.25, 2.0],
    "half": {1: [0, 1, 4], 2: [0, 1]},
    "beyond": [8],
    "points": {1: [3, 8, 17, 128]},
    "schemes": {1: ["GPSE", "DVM"], 2: ["KPSE"]},
    "half_widths": {1: 40.0, 2: 8.0},
}


def test_every_probe_holds_or_is_spoken_of(bad):
    assert bad == ""


def test_sums_and_matrices_hold_on_one_particle_and_more(table):
    kinds = table[table["kind"].isin(["sums", "matrix"])]
    assert set(kinds["verdict"]) == {"held"}


def test_what_does_not_fit_is_warned_of_and_what_is_no_lattice_is_refused(table):
    verdicts = table.groupby("kind")["verdict"].agg(set)
    assert verdicts["refused"] == {"refused"}
    for kind in ("overlap", "too coarse", "too narrow", "off centre", "hidden", "graded"):
        assert "warned" in verdicts[kind], kind


def test_no_run_is_wrong_without_a_word(result):
    silent = result.series[result.series["series"] == "silent"]
    assert silent["y"].max() < 0.3
    assert silent["x"].max() <= 1.0


def test_the_figure_is_drawn(drawn):
    assert len(drawn.axes) == 1
