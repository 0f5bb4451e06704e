"""Observed orders in a table of errors."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from fracstudy.orders import fitted_power, orders_by, orders_of


def test_orders_are_those_within_each_group():
    rows = {
        "scheme": ["a", "b", "a", "b"],
        "h": [0.2, 0.4, 0.1, 0.2],
        "error": [4.0, 8.0, 1.0, 1.0],
    }
    orders = orders_by(pd.DataFrame(rows, index=[3, 1, 2, 0]), "scheme", "error")
    assert orders[[3, 1]].isna().all()
    assert orders[[2, 0]].to_numpy() == pytest.approx([2.0, 3.0])


def test_orders_of_an_index_are_those_that_the_paper_writes():
    index = pd.MultiIndex.from_product([["KPSE"], ["II", "IV"]], names=["scheme", "order"])
    assert list(orders_of(index)) == [2, 4]


def test_the_power_of_a_power_law_is_found():
    x = np.array([0.5, 1.0, 3.0, 7.0])
    assert fitted_power(x, 2.0 * x**-2.5) == pytest.approx(-2.5)
