"""Exchange forms on irregular particles: conserved to round-off, as inaccurate as predicted, never growing unsaid."""

from __future__ import annotations

import numpy as np

from fracstudy.probe import Verdict

PARAMETERS = {
    "particles": 101,
    "half_width": 5.0,
    "overlap": 4.0,
    "jitters": [0.1, 0.5],
    "seeds": 2,
    "levels": [51, 101],
}


def test_nothing_is_wrong_without_a_word(bad):
    assert bad == ""


def test_conservation_is_exact(table):
    kept = table[table["kind"] == "conservation"]
    assert len(kept) > 40
    assert set(kept["verdict"]) == {Verdict.HELD}


def test_growth_is_warned_of(table):
    grows = table[table["expected"].str.startswith(("growth", "amplifies"))]
    assert len(grows) > 10
    assert set(grows["verdict"]) == {Verdict.WARNED}


def test_the_volumes_tell(result, drawn):
    jitter = result.series[(result.series["panel"] == "jitter") & (result.series["x"] == 0.5)]
    errors = jitter.pivot_table(index="series", columns="right", values="y")
    assert (errors[False] > 2.0 * errors[True])[["KPSE", "GPSE"]].all()
    assert np.isfinite(result.series["y"]).all()
    assert len(drawn.axes) == 2
