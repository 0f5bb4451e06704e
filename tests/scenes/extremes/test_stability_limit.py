"""The stability limit: nothing is silent, nothing fails, and what grows is spoken of."""

from __future__ import annotations

PARAMETERS = {
    "half": 12,
    "overlaps": [0.5, 2.0],
    "orders": [4],
    "factors": [0.9, 1.1],
    "map_betas": [0.1, 0.9],
    "map_overlaps": [0.5, 1.0, 2.0],
}


def test_every_probe_holds_or_is_spoken_of(bad):
    assert bad == ""


def test_what_grows_warns_and_what_means_nothing_is_refused(table):
    verdicts = table.groupby("kind")["verdict"].agg(set)
    assert verdicts["hidden growth"] == {"warned"}
    assert verdicts["refused"] == {"refused"}
    assert verdicts["a word"] == {"held", "warned"}


def test_most_probes_have_an_independent_value(table):
    assert (table["source"] != "").mean() > 0.8


def test_the_figure_is_drawn(drawn):
    assert len(drawn.axes) == 11
