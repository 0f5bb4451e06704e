"""The exchange on one placement, exactly in time.

With S of d(V^(1/2) u)/dt = S V^(1/2) u, which is symmetric,

    S_ij = V_i^(1/2) K_ij V_j^(1/2),   S_ii = -sum_j K_ij V_j,   u(t) = V^(-1/2) exp(t S) V^(1/2) u(0),

The exponential is a Chebyshev series (`time.chebyshev`) at first. Once all series together have taken as long as the
eigenvectors of S do, the eigenvectors are computed and take their place. With a diffusivity that varies, K_ij is
multiplied by (D_i + D_j) / 2, as in `variable.diffusivity`. This is another equation than that of the flux,

    u_t = C int (D(x) + D(y)) / 2 (u(y) - u(x)) |x - y|^(-1-alpha) dy = (D L u + L(D u) - u L D) / 2,

with L = -(-Laplacian)^(alpha/2). Both ways conserve sum V u.
"""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from scipy.linalg import eigh

from fracparticles.adaptive.exchange import Placed, exchange_matrix
from fracparticles.arguments import FloatArray
from fracparticles.time.chebyshev import LostDigits, evaluate, exponential

__all__ = ["ExchangeFlow"]

_PRODUCTS = 0.5  # N of them, of the matrix with a vector, take as long as the eigenvectors


class ExchangeFlow:
    """u after a time from u before, on one placement.

    Parameters
    ----------
    particles : Placed
    alpha : float
    near : int
        q of `near_weights`.
    diffusivity : float or array, shape (N,)
        D, or D at the particles.
    """

    def __init__(
        self, particles: Placed, alpha: float, near: int, diffusivity: float | FloatArray
    ) -> None:
        volumes = particles.volumes
        exchange = exchange_matrix(particles, alpha, near)
        d = np.broadcast_to(diffusivity, volumes.shape)
        exchange *= 0.5 * (d[:, None] + d)
        self._root = np.sqrt(volumes)
        out = exchange @ volumes
        # By Gershgorin's circles of V^(-1/2) S V^(1/2), which has the same eigenvalues.
        self._bound = float((np.abs(exchange) @ volumes + np.abs(out)).max())
        self._form = exchange * self._root[:, None] * self._root
        np.fill_diagonal(self._form, -out)
        self._modes: tuple[FloatArray, FloatArray] | None = None
        self.size, self._products = self._root.size, 0.0

    def __call__(self, u: FloatArray, time: float) -> FloatArray:
        """Return u after this time, shape (N,)."""
        root = self._root
        start = root * u
        if self._bound == 0.0:
            return u
        self._products += float(np.sqrt(25.0 * time * self._bound))
        y = None
        if self._products < _PRODUCTS * self.size:
            with suppress(LostDigits):  # where u is all short waves, of which little remains
                y = evaluate((exponential(time, -self._bound, 0.0),), self, start)[0]
        if y is None:
            if self._modes is None:
                self._modes = eigh(self._form)
            rates, modes = self._modes
            y = modes @ (np.exp(time * np.minimum(rates, 0.0)) * (modes.T @ start))
        y += root * (root @ (start - y)) / (root @ root)  # sum V u to the last digit
        return np.asarray(y / root)

    def combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float = 0.0, keep: float = 0.0
    ) -> None:
        """Write scale S u + shift u + keep out into `out`; u and out are different arrays."""
        out *= keep
        out += scale * (self._form @ u) + shift * u

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return S u."""
        return np.asarray(self._form @ u)
