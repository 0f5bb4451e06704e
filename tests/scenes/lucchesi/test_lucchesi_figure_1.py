"""Fig. 1: what the study sees in the kernels."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from scenes.lucchesi.lucchesi_figure_1.figure import figure
from scenes.lucchesi.lucchesi_figure_1.study import study, tail_exponent


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize(
    ("name", "order"), [("kappa", 2), ("kappa", 4), ("E", 2), ("K", 2), ("K", 4)]
)
def test_tail_exponent(name, order, alpha):
    """The next term of kappa and K is smaller by r^-2, of E by r^-alpha: 3e-6 at r = 1e5 and alpha = 1.1."""
    expected = 1.0 - alpha if name == "kappa" else -1.0 - alpha
    assert tail_exponent(name, alpha, order) == pytest.approx(expected, abs=1e-5)


def test_kernels():
    result = study(Inputs("fig", ["L-F1"]), beta=[0.1, 0.5, 0.9], points=401)
    verdicts = {finding.claim: finding.verdict for finding in result.findings}
    refuted = verdicts.pop("L-F1.K_positive.IV")
    assert not refuted
    assert all(verdicts.values())
    reason = {finding.claim: finding.reason for finding in result.findings}["L-F1.K_positive.IV"]
    assert "beta = 0.9" in reason
    assert "beta = 0.5" not in reason
    drawn = figure(result.series, result.table)
    assert len(drawn.axes) == 3
    drawn.draw_without_rendering()


def test_order_four_is_positive_at_small_beta():
    """So the verdict on K follows the data."""
    result = study(Inputs("fig", ["L-F1"]), beta=[0.1], points=401)
    assert all(finding.verdict for finding in result.findings)
