"""Variable order: errors, interpolation and tails, on the smoke grid."""

from __future__ import annotations

import pytest

from fracstudy.panels import pick


def ours(result, **values):
    return pick(result.table, **values)["ours"].to_numpy()


def test_it_has_the_order_of_the_kernels(result):
    # Reached from below, and the distance from it falls like h^2: extrapolate it from two.
    observed = pick(result.table, case="line, order 4")["observed order"].to_numpy()
    assert observed[-1] + (observed[-1] - observed[-2]) / 3.0 == pytest.approx(4.0, abs=0.1)


def test_interpolation_stays_below_its_bound(result):
    rows = pick(result.table, part="interpolation")
    assert (rows["ours"] <= rows["theory"]).all()
    assert rows["ours"].min() < 1e-14


def test_a_constant_order_is_that_of_direct_differentiation(result):
    assert ours(result, part="constant order").item() < 1e-14


def test_each_tail_has_the_order_of_its_end(result):
    # The next terms are smaller by |x|^-alpha and by |x|^-1, at |x| = 80.
    for part in ("tail, exponent", "tail, amplitude"):
        rows = pick(result.table, part=part)
        assert rows["ours"].to_numpy() == pytest.approx(rows["theory"].to_numpy(), rel=0.02)


def test_the_tail_of_each_end_is_better_than_one_for_both_and_that_than_none(result):
    own, one, none = (
        ours(result, part="exterior", case=case) for case in ("own", "one for both", "none")
    )
    assert (own < one).all()
    assert (one < none).all()
    assert own[-1] < 0.1 * own[0]  # twice as wide


def test_the_figure_has_its_panels(panels):
    assert len(panels) == 4
