"""A young narrow blob and an old wide one: scales that differ by a hundred."""

from __future__ import annotations

import numpy as np

from fracstudy.race.problem import Points, Problem

_YOUNG = 0.001


class TwoScales(Problem):
    """0.3 G(x, 0.001) + 0.7 G(x - 2, 0.5)."""

    name, title, place = "two scales", "two scales", 5
    dims = (1, 2)
    finest = 0.02

    def initial(self, x: Points) -> np.ndarray:
        """Return the data."""
        return 0.3 * self.green(x, _YOUNG) + 0.7 * self.green(x, 0.5, (2.0,))

    def exact(self, x: Points) -> np.ndarray:
        """Return the solution."""
        return 0.3 * self.green(x, _YOUNG + 1.0) + 0.7 * self.green(x, 1.5, (2.0,))
