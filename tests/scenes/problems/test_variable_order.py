"""Variable order: the order of the rows, the bound of their interpolation, the tails, on the smoke grid."""

from __future__ import annotations

from pathlib import Path

import pytest

from fracstudy.inputs import Inputs
from fracstudy.panels import pick
from fracstudy.scene import call, read_scenes

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def scene():
    return read_scenes(ROOT / "workflow/scenes", ["problems"], smoke=True)["variable_order"]


@pytest.fixture(scope="module")
def result(scene):
    return call(scene.function("study"), Inputs("variable_order"), **scene.parameters)


def test_errors_fall_by_the_order_of_the_kernels(result):
    # From h = 0.1 to 0.05, epsilon = 0.2: the order is still reached from below.
    for order, observed in ((2, 1.88), (4, 3.58)):
        fine = pick(result.table, what="operator", dim=1, order=order).iloc[-1]
        assert fine["observed order"] == pytest.approx(observed, abs=0.01)


def test_interpolation_is_below_its_bound(result):
    for _, points in pick(result.series, panel="sums").groupby("series"):
        ours, bound = (pick(points, kind=kind)["y"].to_numpy() for kind in ("ours", "bound"))
        assert (ours <= bound).all()
        assert ours[-1] < 1e-15  # round-off of weights below 1


def test_each_end_has_the_tail_of_its_order(result):
    for side in ("left", "right"):
        row = pick(result.table, what=f"tail, {side}").iloc[0]
        # The next term of the tail is |x|^-1.2 of it at most, of some factor of one; fitted from 100 to 200.
        assert row["ours"] == pytest.approx(row["exact"], abs=0.02)


def test_the_continuation_is_worth_two_digits(result):
    opened, truncated = (
        pick(result.table, what=f"solution, {exterior}")["error"].item()
        for exterior in ("open", "truncated")
    )
    assert opened < 1e-5 < 1e-4 < truncated


def test_the_figure_can_be_drawn(scene, result):
    drawn = call(scene.function("figure"), result.series, result.table, **scene.parameters)
    assert len(drawn.axes) == 4
