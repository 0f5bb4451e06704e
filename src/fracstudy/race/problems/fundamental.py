"""The papers' problem: from the fundamental solution at t = 0.5 to that at t = 1.5."""

from __future__ import annotations

import numpy as np

from fracstudy.race.problem import Points, Problem


class Fundamental(Problem):
    """G(x, 0.5), even and centred, with the tail of the solution itself."""

    name, title, place = "fundamental", "fundamental solution", 1

    def initial(self, x: Points) -> np.ndarray:
        """Return G(x, 0.5)."""
        return self.green(x, 0.5)

    def exact(self, x: Points) -> np.ndarray:
        """Return G(x, 1.5)."""
        return self.green(x, 1.5)
