"""The first attempt at an exchange scheme, Eq. (29), which the paper rejects:

    du_i/dt = (D / epsilon^alpha) sum_j V_j (u_j - u_i) G_epsilon(x_j - x_i).

This is DD in exchange form. On the infinite lattice the sum of G vanishes and (29) is DD. On a bounded lattice the
missing far weights make the diagonal positive, and with it some eigenvalues.
"""

from __future__ import annotations

import numpy as np

from fracparticles.schemes.base import Exchange
from fracparticles.schemes.setting import Setting


class Scheme29(Exchange):
    """PSE29."""

    name, place = "PSE29", 8
    title = "Scheme (29), rejected"
    equation, kernel = "Eq. (29)", "Eq. (11)"
    kernel_name = "G"
    orders = (2, 4)
    rejected = True
    dissipative = False
    colour, marker = "#999999", "X"

    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D: the symbol of DD minus its value at theta = 0."""
        at_zero = self.scaled_transform(np.zeros(1), setting)
        return self.scaled_transform(theta, setting) - at_zero
