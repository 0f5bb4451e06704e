"""The partial sums of Figs A.10-A.12."""

from __future__ import annotations

import pytest
from matplotlib.figure import Figure

from fracstudy.inputs import Inputs
from scenes.lucchesi.expansions.figure import figure
from scenes.lucchesi.expansions.study import study


@pytest.mark.parametrize(("alpha", "item"), [(1.1, "L-FA10"), (1.9, "L-FA12")])
def test_expansions(alpha, item):
    shown = {"series_terms": [5, 80], "asymptotic_terms": [1, 20]}
    result = study(Inputs("a", [item]), alpha=alpha, terms=[1, 5, 20, 80, 320], **shown)
    assert [f.claim for f in result.findings] == [
        f"{item}.{n}" for n in ("series", "even", "asymptotic", "overlap")
    ]
    series, even, asymptotic, overlap = (finding.numbers for finding in result.findings)
    assert series["gain"] > 1.0
    assert asymptotic["gain"] > 1.0
    assert max(even.values()) < 1e-13
    assert overlap["far"] > overlap["near"]


def test_too_few_terms_do_not_overlap():
    shown = {"series_terms": [1], "asymptotic_terms": [1]}
    result = study(Inputs("a", ["L-FA11"]), alpha=1.5, terms=[1, 2, 3], **shown)
    assert result.findings[-1].numbers["ratio"] < 1.0
    drawn = figure(result.series, alpha=1.5)
    assert isinstance(drawn, Figure)
    drawn.draw_without_rendering()
