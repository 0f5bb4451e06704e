"""Transport with a velocity field on the lattice: du_i/dt = -div(a u), by exchange of the flux, as in Eq. (25).

    du_i/dt = (1 / h) sum_d sum_j c_{i-j} (F_j + F_i),    F = a_d u,    c_m = -s^(-2) eta1(m / s),

This is the second pass of FPSE, with the flux of the velocity in place of the fractional one. It goes along the lines
of the lattice in each coordinate d, with the kernel of one dimension, so that it has every order. c is odd: i takes
what j gives, and on a truncated lattice sum_i u_i stays to round-off. The shortest waves of the lattice stand still.

In an open exterior the flux is also taken at the points next to the ends, as far as c reaches; then the sum over all
neighbours of c F_i is zero. There the solution is continued as it falls far away: on the line by the powers
|x|^(-1-k alpha), k = 1 .. `far_terms`, that meet it as those of the diffusion do, see `lattice.exterior`; in the plane
from the last particle of each line of the lattice, u(x) = u(x_end) (|x_end| / |x|)^(2+alpha).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.sums import sums_of_weights
from fracparticles.schemes import Setting
from fracparticles.schemes.fpse import divergence_weights

__all__ = ["Transport"]

_WAVES = 257  # wavenumbers among which the greatest value of the symbol is taken


class Transport:
    """-div(a u) on a lattice.

    Parameters
    ----------
    setting : Setting
        The lattice, the order and the overlap; its diffusivity is not used.

    Attributes
    ----------
    points : tuple of tuples of arrays
        For each d the coordinates of the places where a_d is needed. They broadcast to the lattice; in an open exterior
        it is longer by some points at either end along d.
    """

    def __init__(self, setting: Setting) -> None:
        self._dim, self._size, self._h = setting.dim, setting.size, setting.spacing
        reach = BandedConvolution.reach(setting.overlap, setting.order, setting.family)
        line = replace(setting, dim=1, kernel_table=None)
        c = divergence_weights(np.arange(reach + 1.0), line)
        self._divergence = BandedConvolution(c, parity=-1)
        self._weights = c
        self._fastest = float(self.symbol(np.linspace(0.0, np.pi, _WAVES)).max()) / setting.spacing
        self._pad = reach if setting.is_open else 0
        self._diagonal = None
        if not setting.is_open:
            self._diagonal = sums_of_weights(c, parity=-1, size=setting.size)
        inside = np.arange(-setting.n, setting.n + 1) * setting.spacing
        ends = setting.n + self._pad
        longer = np.arange(-ends, ends + 1) * setting.spacing
        self.points = tuple(
            tuple(
                np.meshgrid(
                    *(longer if axis == d else inside for axis in range(setting.dim)),
                    indexing="ij",
                    sparse=True,
                )
            )
            for d in range(setting.dim)
        )
        self._depth, self._falls = np.zeros(1, dtype=int), [np.zeros(0)] * setting.dim
        if self._pad and setting.dim == 1:
            self._depth, self._falls[0] = self._powers(setting)
        elif self._pad:
            self._falls = [self._fall(d, setting.alpha) for d in range(setting.dim)]

    def symbol(self, theta: np.ndarray) -> np.ndarray:
        """Return the value that stands for the wavenumber theta = k h: about theta for small ones, zero at pi."""
        return np.abs(2.0 * np.sin(theta[:, None] * np.arange(self._weights.size)) @ self._weights)

    def _powers(self, setting: Setting) -> tuple[np.ndarray, np.ndarray]:
        """Return depths p from the end, and the weights of u_(n-p) at the points beyond it, shape (terms, pad)."""
        n, powers = setting.n, 1.0 + setting.alpha * np.arange(1, setting.far_terms + 1)
        depth = np.array([round(n * share) for share in (0.0, 0.25, 0.5)[: setting.far_terms]])
        # The inverse takes strengths at the depths to the amplitudes of the powers.
        met = (n / (n - depth)[:, None]) ** powers
        beyond = (n / np.arange(n + 1, n + self._pad + 1)[:, None]) ** powers
        return depth, np.linalg.solve(met.T, beyond.T)

    def _fall(self, d: int, alpha: float) -> np.ndarray:
        """Return (|x_end| / |x|)^(2+alpha) beyond the right end along d, as the weights of one depth."""
        square = np.moveaxis(np.asarray(sum(np.square(part) for part in self.points[d])), d, 0)
        fall = (square[-self._pad - 1] / square[-self._pad :]) ** (1.0 + 0.5 * alpha)
        return np.moveaxis(fall, 0, d)[None]

    def apply(self, u: np.ndarray, velocity: Sequence[np.ndarray]) -> np.ndarray:
        """Return -div(a u).

        Parameters
        ----------
        u : array, shape (N, .., N)
            Particle strengths.
        velocity : sequence of arrays
            a_d at `points[d]`, of their shape, or single numbers.
        """
        total = np.zeros(u.shape)
        for d, speed in enumerate(velocity):
            flux = speed * (self._extended(u, d) if self._pad else u)
            part = self._divergence.along(np.ascontiguousarray(flux), d, self._size)
            if self._diagonal is not None:
                shape = [1] * u.ndim
                shape[d] = -1
                part += self._diagonal.reshape(shape) * flux
            total += part
        total /= self._h
        return total

    def _extended(self, u: np.ndarray, d: int) -> np.ndarray:
        """Return u with the points beyond the ends of its lines along d."""
        shape = list(u.shape)
        shape[d] += 2 * self._pad
        longer = np.empty(shape)
        lines, inside = np.moveaxis(longer, d, 0), np.moveaxis(u, d, 0)
        lines[self._pad : -self._pad] = inside
        right, left = np.zeros_like(lines[: self._pad]), np.zeros_like(lines[: self._pad])
        for p, fall in zip(self._depth, self._falls[d], strict=True):
            along = np.moveaxis(np.atleast_1d(fall), d, 0)
            right += along * inside[-1 - p]
            left += along * inside[p]
        lines[-self._pad :], lines[: self._pad] = right, np.flip(left, 0)
        return longer

    def fastest(self, velocity: Sequence[np.ndarray]) -> float:
        """Return a bound of |lambda| on the infinite lattice, where each wave has the greatest speed."""
        return self._fastest * sum(float(np.abs(speed).max()) for speed in velocity)
