"""The data of a figure in long form: one row for each point, with its panel and its series."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

__all__ = ["Panels", "pick"]

_COLUMNS = ("panel", "series", "x", "y")


class Panels:
    """Collects the points of a figure: columns panel, series, x, y, and others that are given by name."""

    def __init__(self) -> None:
        self._parts: list[pd.DataFrame] = []

    def add(self, *columns: Any, **more: Any) -> None:
        """Add points by panel, series, x and y, or by name; each but `x` is one value for all or one for each point."""
        points = dict(zip(_COLUMNS, columns, strict=False)) | more
        self._parts.append(pd.DataFrame(points | {"x": np.atleast_1d(points["x"])}))

    @property
    def frame(self) -> pd.DataFrame:
        """All points."""
        return pd.concat(self._parts, ignore_index=True)


def pick(frame: pd.DataFrame, /, **values: Any) -> pd.DataFrame:
    """Return the rows of a frame that have these values in these columns."""
    for column, value in values.items():
        frame = frame[frame[column] == value]
    return frame
