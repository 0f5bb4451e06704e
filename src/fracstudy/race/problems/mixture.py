"""Two blobs off the centre, of two ages."""

from __future__ import annotations

import numpy as np

from fracstudy.race.problem import Points, Problem

_PARTS = ((0.6, (1.5, 0.5, 0.2), 0.5), (0.4, (-1.0, 0.3), 0.7))  # share, centre, age


class Mixture(Problem):
    """0.6 G(x - a, 0.5) + 0.4 G(x - b, 0.7), a = (1.5, 0.5, 0.2), b = (-1, 0.3, 0)."""

    name, title, place = "mixture", "off-centre mixture", 2

    def initial(self, x: Points) -> np.ndarray:
        """Return the data."""
        return self._mixture(x, 0.0)

    def exact(self, x: Points) -> np.ndarray:
        """Return the same, each part older by 1."""
        return self._mixture(x, self.time)

    def _mixture(self, x: Points, later: float) -> np.ndarray:
        parts = [share * self.green(x, age + later, at[: self.dim]) for share, at, age in _PARTS]
        return np.sum(parts, axis=0)
