"""Observed orders in a table of errors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracstudy.inputs import ORDERS

__all__ = ["observed", "orders_by", "orders_of"]


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
    """Return the orders of an index with a level `order`, in which they stand as the paper writes them, as numbers."""
    return index.get_level_values("order").map({name: order for order, name in ORDERS.items()})
