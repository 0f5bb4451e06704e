"""Observed orders and powers, of the errors in a table."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from fracparticles.run.orders import observed_order
from fracstudy.inputs import ORDERS

__all__ = ["fitted_power", "observed", "orders_by", "orders_of"]


def fitted_power(x: ArrayLike, y: ArrayLike) -> float:
    """Return the p of the law y = c x^p that fits the logarithms of the points with the least squares."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def observed(h: Sequence[float], errors: Sequence[float]) -> list[float]:
    """Return for each level the observed order between it and the one before; nan for the first."""
    return [np.nan, *observed_order(h, errors)]


def orders_by(table: pd.DataFrame, by: str | Sequence[str], error: str) -> pd.Series:
    """Return for each row the observed order between it and the row before in its group; nan for the first ones."""
    orders = pd.Series(np.nan, index=table.index)
    for _, part in table.groupby(by):
        orders[part.index[1:]] = observed_order(part["h"], part[error])
    return orders


def orders_of(index: pd.MultiIndex) -> pd.Index:
    """Return the orders of an index as numbers; its level `order` has them as the paper writes them."""
    return index.get_level_values("order").map({name: order for order, name in ORDERS.items()})
