"""The study of the order in time on a tiny grid."""

from __future__ import annotations

import pytest

from fracstudy.inputs import Inputs
from scenes.lucchesi.time_order.figure import figure
from scenes.lucchesi.time_order.study import study


@pytest.fixture(scope="module")
def result(computed):
    common = {"scheme": ["DD", "FPSE", "KPSE"], "beta": 0.5, "truncation": 5.0, "spacing": 0.2}
    common |= {"store": "profile"}
    blocks = [
        {**common, "dt": [0.0625, 0.03125, 0.015625], "integrator": ["euler", "rk2", "rk4"],
         "evaluation": "stepping"},
        {**common, "integrator": "exponential"},
    ]  # fmt: skip
    return study(Inputs("time_order", ["L-C10"], runs=computed(blocks)))


def test_each_integrator_shows_its_order(result):
    table = result.table
    expected = table["integrator"].map({"RK1": 1.0, "RK2": 2.0, "RK4": 4.0})
    # Two more levels would halve what the next power of dt adds; here dt lambda is about 1/16.
    for column in ("order (49), smallest dt above round-off", "order against exact in time"):
        assert (table[column] - expected).abs().max() < 0.15
    assert (table["error at the smallest dt"] < table["error at the largest dt"]).all()


def test_every_claim_is_measured_and_the_figure_is_drawn(result):
    numbers = {finding.claim: finding.numbers for finding in result.findings}
    assert set(numbers) == {
        f"L-C10.{scheme}.{name}" for scheme in ("DD", "FPSE", "KPSE") for name in ("RK1", "RK2")
    }
    assert all(found["away"]["beta = 0.5"] < 0.15 for found in numbers.values())
    assert figure(result.series).axes
