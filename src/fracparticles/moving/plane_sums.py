r"""Sums over particles that lie anywhere in the plane, of one kernel and of one vector kernel along r:

    u(z) = sum_j U_j eta_eps(z - x_j),     S(z) = sum_j U_j F_eps(z - x_j),     F_eps(r) = F(|r|/eps) r / |r| / eps^2.

As on the line (`moving.scattered`) both are band-limited, since a Gaussian is in them. Cut off smoothly beyond the
largest distance within the set and continued periodically they are Fourier sums, to round-off: the particles are spread
over a lattice by the window of `moving.gridding` in either coordinate, one transform there and three back follow, with
the window divided out, and the results are interpolated to the particles.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.fft import irfft2, next_fast_len, rfft2
from scipy.special import erfc

from fracparticles._compiled import njit
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel
from fracparticles.moving.gridding import WIDTH, window_transform, window_weights

__all__ = ["ACCURACY", "PlaneSums", "naive_sums"]

ACCURACY = 1e-11  # of the largest value of each sum
_BAND = 12.0  # exp(-k^2/4) is 2e-16 there
_EDGE = 5.5  # erfc(5.5) / 2 < 1e-14
_MARGIN = (
    1.125  # how much wider than the set the box is made, so that it is not made anew at every step
)
_MOST = 4096  # lattice points along a side


class PlaneSums:
    """u and S for particles of smoothing length epsilon.

    The periodic box is made when it is needed, and made anew, an eighth wider, when particles leave it. Not to be
    shared between threads.

    Raises `InvalidInput` if there is no such kernel.
    """

    def __init__(self, alpha: float, order: int, epsilon: float) -> None:
        self.alpha, self.order, self.epsilon = alpha, order, epsilon
        kernel("F", 0.0, alpha, 2, order)
        self._centre, self._half = np.zeros(2), -1.0

    def __call__(
        self, x: FloatArray, strength: FloatArray, z: FloatArray | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """Return u, shape (M,), and S, shape (M, 2), at the points z, shape (M, 2), or at the particles.

        Raises `InvalidInput` if the set is too wide for the smoothing length.
        """
        every = x if z is None else np.concatenate([x, z])
        if not (np.abs(every - self._centre) <= self._half).all():
            self._make_box(every)
        at = self._places(x)
        lattice = np.zeros((self._size, self._size))
        _spread(*at[0], *at[1], strength, lattice)
        modes = rfft2(lattice)
        if z is not None:
            at = self._places(z)
        out = np.empty((3, len(at[0][0])))
        for values, coefficients in zip(out, self._coefficients, strict=True):
            field = irfft2(modes * coefficients, s=lattice.shape)
            _interpolate(*at[0], *at[1], field, values)
        return out[0], np.ascontiguousarray(out[1:].T)

    def _places(self, x: FloatArray) -> list[tuple[np.ndarray, np.ndarray]]:
        low = self._centre - self._half
        cells = (x - low) / self._step + WIDTH
        return [window_weights(np.ascontiguousarray(cells[:, axis])) for axis in range(2)]

    def _make_box(self, points: FloatArray) -> None:
        """Fourier coefficients of the three kernels, for the points and a little more."""
        low, high = points.min(axis=0), points.max(axis=0)
        eps = self.epsilon
        half = 0.5 * _MARGIN * float((high - low).max()) + eps
        period = 2.0 * (
            2.0 * half + 2.0 * _EDGE * eps
        )  # differences reach 2 half in each coordinate
        size = next_fast_len(math.ceil(_BAND / eps * period / math.pi), real=True)
        if size > _MOST:
            shown = f"particles {2.0 * half:.6g} apart"
            allowed = (
                f"a set no wider than {2.0 * half * _MOST / size:.4g}, for this smoothing length"
            )
            raise InvalidInput("x", shown, allowed, "Look for a particle that ran away.")
        self._centre, self._half, self._size = 0.5 * (low + high), half, size
        self._step = period / size
        r = np.fft.fftfreq(size, 1.0 / size) * self._step
        cut_off = 0.5 * erfc((np.abs(r) - (0.5 * period - _EDGE * eps)) / eps)
        cut_off = np.multiply.outer(cut_off, cut_off) / eps**2
        # A kernel is evaluated once for each distance.
        distance, back = np.unique(np.hypot(r[:, None], r), return_inverse=True)
        back = back.reshape(size, size)
        even, along = (
            np.asarray(kernel(name, distance / eps, self.alpha, 2, self.order))
            for name in ("eta", "F")
        )
        per_length = cut_off * (along / np.where(distance > 0.0, distance, 1.0))[back]
        window = window_transform(2.0 * np.pi * np.abs(np.fft.fftfreq(size)))
        deconvolved = np.multiply.outer(window, window[: size // 2 + 1]) ** 2
        kernels = (cut_off * even[back], per_length * r[:, None], per_length * r)
        self._coefficients = [rfft2(one) / deconvolved for one in kernels]


def naive_sums(
    x: FloatArray, strength: FloatArray, alpha: float, order: int, epsilon: float
) -> tuple[FloatArray, FloatArray]:
    """Return u and S at the particles by the double loop over pairs: the oracle, O(N^2)."""
    r = x[:, None] - x
    distance = np.hypot(r[..., 0], r[..., 1])
    even, along = (
        np.asarray(kernel(name, distance / epsilon, alpha, 2, order)) / epsilon**2
        for name in ("eta", "F")
    )
    direction = r / np.where(distance > 0.0, distance, 1.0)[..., None]
    return even @ strength, np.einsum("ij,ijk,j->ik", along, direction, strength)


@njit()
def _spread(first, weights, first_y, weights_y, q, out):
    n = out.shape[0]
    for j in range(q.size):
        for a in range(weights.shape[1]):
            row, share = (first[j] + a) % n, q[j] * weights[j, a]
            for b in range(weights_y.shape[1]):
                out[row, (first_y[j] + b) % n] += share * weights_y[j, b]


@njit()
def _interpolate(first, weights, first_y, weights_y, values, out):
    n = values.shape[0]
    for i in range(out.size):
        total = 0.0
        for a in range(weights.shape[1]):
            row, part = (first[i] + a) % n, 0.0
            for b in range(weights_y.shape[1]):
                part += values[row, (first_y[i] + b) % n] * weights_y[i, b]
            total += weights[i, a] * part
        out[i] = total
