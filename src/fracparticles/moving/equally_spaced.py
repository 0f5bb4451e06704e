"""Sums over particles that are equally spaced, as they are after every remeshing: one convolution."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from pyfftw import FFTW, empty_aligned, zeros_aligned
from scipy.fft import next_fast_len, rfft

__all__ = ["PLAN", "EquallySpacedSum", "RowTransforms", "equal_spacing"]

PLAN = ("FFTW_ESTIMATE",)  # the same plan, and so the same bytes, every time
_FEWEST = 32  # particles
_ULPS = 4.0  # that a position p h may be off


def equal_spacing(x: np.ndarray, slack: float = np.inf) -> float | None:
    """Return the spacing of particles that are in order and equally spaced, to round-off; None for others, or for few.

    Far from the origin the round-off of the positions may be more than a sum allows: its `slack`.
    """
    n = x.size
    if n < _FEWEST:
        return None
    first, last = float(x[0]), float(x[-1])
    gap = (last - first) / (n - 1)
    off = min(_ULPS * float(np.spacing(max(abs(first), abs(last)))), slack)
    # One look at the middle spares the whole for nearly all other sets.
    if not gap > 4.0 * off or abs(x[n // 2] - first - n // 2 * gap) > off:
        return None
    return gap if np.abs(x - first - gap * np.arange(n)).max() <= off else None


class RowTransforms:
    """One real transform there, a product with each row of `coefficients`, and the transform of each back.

    Parameters
    ----------
    values : array, shape (L,)
        The buffer that is transformed.
    coefficients : array, shape (K, L/2 + 1)
    """

    def __init__(self, values: np.ndarray, coefficients: np.ndarray) -> None:
        self._coefficients = coefficients
        self._modes = empty_aligned(coefficients.shape[1], complex)
        self._products = empty_aligned(coefficients.shape, complex)
        self._fields = empty_aligned((len(coefficients), values.size))
        back = {"direction": "FFTW_BACKWARD", "flags": (*PLAN, "FFTW_DESTROY_INPUT")}
        self._forward = FFTW(values, self._modes, flags=PLAN)
        self._backward = FFTW(self._products, self._fields, **back)

    def fields(self) -> np.ndarray:
        """Return the K results for what `values` holds now, shape (K, L): a buffer that the next call overwrites."""
        self._forward.execute()
        np.multiply(self._coefficients, self._modes, out=self._products)
        self._backward.execute()
        return self._fields


class EquallySpacedSum:
    """y_i = sum_j q_j K_eps((i - j) h) for each of the kernels.

    Parameters
    ----------
    profiles : sequence of callable
        K(r), for unit smoothing length.
    epsilon, spacing : float
    most : int
        Particles that fit.
    """

    def __init__(
        self,
        profiles: Sequence[Callable[[np.ndarray], np.ndarray]],
        epsilon: float,
        spacing: float,
        most: int,
    ) -> None:
        self.spacing, self.most = spacing, most
        length = 2 * next_fast_len(most, real=True)
        r = np.fft.fftfreq(length, 1.0 / length) * (spacing / epsilon)
        coefficients = rfft(np.array([k(r) for k in profiles])) / (length * epsilon)
        self._values = zeros_aligned(length)
        self._transforms = RowTransforms(self._values, coefficients)

    def holds(self, spacing: float, size: int) -> bool:
        """Return whether so many particles with this spacing, to round-off, can be summed."""
        return size <= self.most and abs(spacing / self.spacing - 1.0) < 1e-14

    def add_to(self, out: np.ndarray, q: np.ndarray) -> None:
        """Write the sums into `out`, shape (K, N)."""
        self._values[: q.size] = q
        self._values[q.size :] = 0.0
        out[:] = self._transforms.fields()[:, : q.size]
