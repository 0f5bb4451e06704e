"""The points of a figure in long form."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracstudy.panels import Panels, pick


def test_points_are_kept_in_order_with_what_else_is_said_of_them():
    panels = Panels()
    panels.add("a", "line", np.arange(3.0), np.arange(3.0) ** 2, t=1.0)
    panels.add("a", "point", 4.0, 2.0)
    part = pd.DataFrame({"S": ["S4", "S8"], "x": [1.0, 2.0]}, index=[7, 9])
    panels.add("b", part["S"], part["x"], part["x"])
    panels.add("b", "none", [], 0.0)
    frame = panels.frame
    assert list(frame["x"]) == [0.0, 1.0, 2.0, 4.0, 1.0, 2.0]
    assert list(pick(frame, panel="a", series="line")["y"]) == [0.0, 1.0, 4.0]
    assert list(pick(frame, panel="b", series="S8")["x"]) == [2.0]
    assert frame["t"].notna().sum() == 3
