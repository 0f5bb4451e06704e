"""The study of the cube on tiny grids."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from scenes.beyond.three_dimensions.figure import figure
from scenes.beyond.three_dimensions.study import study


@pytest.fixture(scope="module")
def result(computed):
    common = {"beta": 0.5, "dim": 3, "truncation": 4.0, "store": "metrics"}
    blocks = [
        {"scheme": ["DD", "FPSE", "KPSE"], "order": [2, 4], "spacing": [1.1, 0.7], **common}
        | {"integrator": "exponential"},
        {"scheme": "GPSE", "spacing": 0.7, "exterior": ["truncated", "open"], **common},
    ]
    return study(Inputs("three_dimensions", runs=computed(blocks)))


def test_truncated_exchanges_keep_the_mass_that_should_leave(result):
    table = result.table
    truncated = table[(table["exterior"] == "truncated") & (table["scheme"] != "DD")]
    # Conservative: round-off of some thousand terms.
    assert truncated["mass at tf"].to_numpy() == pytest.approx(truncated["mass at t0"], rel=1e-11)
    assert (truncated["mass at tf, exact"] < truncated["mass at tf"]).all()
    gpse = table[table["scheme"] == "GPSE"].set_index("exterior")
    excess = gpse["mass at tf"] - gpse["mass at tf, exact"]
    # The closure leaves out terms of relative size (R / D)^2 = 1 / C^2 of what is outside.
    assert abs(excess["open"]) < excess["truncated"] / 16.0


def test_sizes_orders_and_figure(result):
    table, series = result.table, result.series
    assert set(table["N"]) == {"17^3", "27^3"}
    # Two h for six pairs of scheme and order.
    assert table["order from the h above"].notna().sum() == 6
    assert (series["work"] > 0.0).all()
    assert len(figure(series).axes) == 2
