"""The study of the smoothing length on a tiny grid."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from scenes.lucchesi.overlap.figure import figure
from scenes.lucchesi.overlap.study import study


@pytest.fixture(scope="module")
def result(computed):
    common = {"beta": 0.5, "spacing": 0.05, "overlap": [1.0, 2.0, 4.0], "store": "metrics"}
    common |= {"truncation": 10.0, "exterior": ["open", "truncated"]}
    blocks = [
        {"scheme": ["DD", "FPSE", "KPSE"], "order": [2, 4], "dt": 1e-3, **common},
        {"scheme": "GPSE", **common},
    ]
    inputs = Inputs("overlap", ["L-C9"], runs=computed(blocks))
    return study(inputs, shown_beta=0.5, claimed_from=1.0)


def test_the_smoothing_error_has_the_power_of_its_order(result):
    table = result.table
    opened = table[(table["exterior"] == "open") & (table["scheme"] != "GPSE")]
    # The next term of the smoothing error is (epsilon k)^2 smaller, epsilon <= 0.2.
    for row in opened.itertuples():
        assert row[-1] == pytest.approx({"II": 2.0, "IV": 4.0}[row.order], abs=0.25)


def test_gpse_keeps_the_overlap_asked_for(result):
    gpse = result.table[result.table["scheme"] == "GPSE"]
    assert gpse.filter(like="error, ε").notna().all(axis=None)


def test_every_claim_has_a_verdict_and_the_figure_is_drawn(result):
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    # On a short lattice truncation hides the smoothing error of KPSE, not those of DD and FPSE.
    assert verdicts["L-C9.DD"] is False
    assert verdicts["L-C9.FPSE"] is False
    assert "L-C9.KPSE" in verdicts
    assert all(finding.reason for finding in result.findings if not finding.verdict)
    assert len(figure(result.series, result.table, shown_beta=0.5).axes) == 2
