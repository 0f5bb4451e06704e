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


def test_how_sensitive_each_scheme_is(result):
    numbers = {finding.claim: finding.numbers for finding in result.findings}
    # From epsilon = 2 h to 4 h the smoothing error grows by 2^2 and 2^4; DD and FPSE show it whatever the truncation.
    assert numbers["L-C9.FPSE"]["change"]["II"] == pytest.approx(3.0, abs=0.3)
    assert numbers["L-C9.DD"]["change"]["IV"] > 5.0
    # On a short lattice truncation hides it in KPSE IV.
    assert numbers["L-C9.KPSE"]["change"]["IV"] < 0.25
    # At these overlaps the quadrature error is exp(-(2 pi)^2), and the order that of the kernel.
    assert max(numbers["L-C9.DD"]["order"].values()) < 0.15
    assert len(figure(result.series, shown_beta=0.5).axes) == 2
