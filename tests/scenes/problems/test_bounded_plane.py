"""Disc and square: orders, totals, decay, and what truncated schemes solve, on the smoke grid."""

from __future__ import annotations

from fracstudy.panels import pick

PARAMETERS = {"finest": 64, "sides": [16, 32]}


def test_the_disc_has_the_order_four_less_alpha(result):
    for part in ("first eigenvalue", "Getoor, mean error"):
        last = pick(result.table, part=part, case="disc").iloc[-1]
        assert last["error"] < 1e-4 * max(last["exact"], 1.0)
        assert last["observed order"] > 2.5 - 0.3


def test_the_fitted_lattice_is_far_better_than_the_plain_one(result):
    fitted, plain = (
        pick(result.table, part="first eigenvalue", case=f"square, {kind}")
        for kind in ("fitted", "plain")
    )
    assert (fitted["error"].to_numpy() < 0.01 * plain["error"].to_numpy()).all()


def test_reflecting_totals_stay(result):
    assert pick(result.table, part="drift of the total, reflecting")["error"].max() < 1e-12


def test_decay_is_that_of_the_spectral_method(result):
    assert pick(result.table, part="decay")["error"].max() < 1e-4


def test_truncated_kpse_reflects_and_truncated_dd_absorbs(result):
    rates = pick(result.table, part="greatest rate of a constant")
    assert pick(rates, case="KPSE")["ours"].max() < 1e-12
    assert pick(rates, case="DD")["ours"].min() > 1.0
    for case in ("DD", "KPSE"):
        rows = pick(result.table, part="decay of the longest wave", case=case)
        assert rows["error"].is_monotonic_decreasing


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 4
