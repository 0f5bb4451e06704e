r"""Sums over particles that lie anywhere in the plane: a field and its flux.

    u(z) = sum_j q_j eta_eps(z - x_j),     f(z) = sum_j q_j F_eps(z - x_j),     K_eps(r) = eps^-2 K(r / eps),

by non-uniform fast Fourier transforms, as on the line (`scattered`): the particles are spread over a square lattice by
the window of `gridding`, one factor an axis, the kernels are cut off smoothly beyond the largest distance along either
axis and continued periodically, the window is divided out twice. O(N log N); `naive_sums` is the sum over all pairs.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.fft import irfft2, next_fast_len, rfft2
from scipy.special import erfc

from fracparticles import arguments as check
from fracparticles._compiled import njit
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel
from fracparticles.moving.gridding import WIDTH, window_transform, window_weights
from fracparticles.moving.scattered_base import EDGE, GAUSSIAN_BAND, MARGIN, in_range

__all__ = ["PlaneSums", "naive_sums"]

_MOST_MODES = 2**13  # along an axis: 0.5 GiB a field


class _Box(NamedTuple):
    """A lattice for sets up to a width: its step, and the Fourier coefficients of the kernels, shape (3, ..).

    It is made as a whole and never changed, so that threads may share the sums.
    """

    width: float
    step: float
    coefficients: np.ndarray


class PlaneSums:
    """The sums of eta and of the two components of F.

    Parameters
    ----------
    alpha : float
    order : int
        Of the kernels.
    epsilon : float
        Smoothing length.

    Attributes
    ----------
    accuracy : float
        Bounds the error relative to the largest value.
    """

    accuracy = 1e-11

    def __init__(self, alpha: float, order: int, epsilon: float) -> None:
        self._alpha, self._order, self._epsilon = alpha, order, check.scale("epsilon", epsilon)
        self._box = _Box(0.0, 0.0, np.empty((3, 0, 0)))

    def __call__(
        self,
        x: np.ndarray,
        y: np.ndarray,
        q: np.ndarray,
        at: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> np.ndarray:
        """Return u, f_x and f_y at the points `at`, or at the particles themselves, shape (3, M).

        Raises `InvalidInput` if the arrays do not fit together or the set is too wide.

        Parameters
        ----------
        x, y, q : array, shape (N,)
        at : tuple of two arrays, shape (M,)
        """
        zx, zy = (x, y) if at is None else at
        if not (x.shape == y.shape == q.shape and zx.shape == zy.shape):
            shown = ", ".join(str(one.shape) for one in (x, y, q, zx, zy))
            raise InvalidInput(
                "x, y, q", shown, "arrays of one shape", "Give one of each a particle."
            )
        q, exponent = in_range(q)
        low = np.array([min(x.min(), zx.min()), min(y.min(), zy.min())])
        high = np.array([max(x.max(), zx.max()), max(y.max(), zy.max())])
        width = float((high - low).max())
        box = self._box
        if not width <= box.width:
            box = self._box = self._made_box(MARGIN * width if box.width else width)
        # The set in the middle of half the period.
        origin = 0.5 * (low + high) - 0.5 * box.width - WIDTH * box.step
        size = box.coefficients.shape[1]
        lattice = np.zeros((size, size))
        places = [window_weights((v - o) / box.step) for v, o in zip((x, y), origin, strict=True)]
        _spread(*places[0], *places[1], q, lattice)
        modes = rfft2(lattice)
        fields = irfft2(box.coefficients * modes, s=(size, size), axes=(1, 2), overwrite_x=True)
        if at is not None:
            places = [
                window_weights((v - o) / box.step) for v, o in zip((zx, zy), origin, strict=True)
            ]
        out = np.empty((3, zx.size))
        _interpolate(*places[0], *places[1], fields, out)
        return np.asarray(np.ldexp(out, exponent))

    def _made_box(self, width: float) -> _Box:
        """Return that of sets up to this width, and a little more."""
        scale = self._epsilon  # of the cut-off: its band is that of the Gaussian
        width = width + scale
        period = 2.0 * (width + 2.0 * EDGE * scale)
        needed = GAUSSIAN_BAND / self._epsilon * period / math.pi + 4 * WIDTH
        if not needed <= _MOST_MODES:
            shown, most = (
                f"particles {width:.4g} apart",
                _MOST_MODES * math.pi / GAUSSIAN_BAND / 2.0,
            )
            allowed = f"a set no wider than {most * self._epsilon:.4g}, for this smoothing length"
            raise InvalidInput("x", shown, allowed, "Look for a particle that ran away.")
        size = 2 * next_fast_len(math.ceil(0.5 * needed), real=True)
        step = period / size
        r = np.fft.fftfreq(size, 1.0 / size) * step
        cut = 0.5 * erfc((np.abs(r) - (0.5 * period - EDGE * scale)) / scale)
        kernels = _kernels(r[:, None], r, self._alpha, self._order, self._epsilon)
        window = window_transform(2.0 * math.pi / size * np.arange(size // 2 + 1))
        both = np.concatenate([window, window[1 : (size + 1) // 2][::-1]])
        transforms = rfft2(kernels * (cut[:, None] * cut))
        return _Box(width, step, transforms / np.square(both[:, None] * window))


def naive_sums(
    x: np.ndarray, y: np.ndarray, q: np.ndarray, alpha: float, order: int, epsilon: float
) -> np.ndarray:
    """Return u, f_x and f_y at the particles by the sum over all pairs, shape (3, N)."""
    return np.asarray(_kernels(x[:, None] - x, y[:, None] - y, alpha, order, epsilon) @ q)


def _kernels(x: np.ndarray, y: np.ndarray, alpha: float, order: int, epsilon: float) -> np.ndarray:
    """eta_eps, and the components of F_eps."""
    r = np.hypot(x, y)
    radial: Callable[[str], np.ndarray] = lambda name: (  # noqa: E731
        np.asarray(kernel(name, r / epsilon, alpha, 2, order)) / epsilon**2
    )
    along = radial("F") / np.where(r > 0.0, r, 1.0)
    return np.array([radial("eta"), along * x, along * y])


@njit(error_model="numpy", fastmath={"contract"})
def _spread(first_x, phi_x, first_y, phi_y, q, out):
    for j in range(q.size):
        for a in range(WIDTH):
            row = out[first_x[j] + a, first_y[j] : first_y[j] + WIDTH]
            strength = q[j] * phi_x[j, a]
            for b in range(WIDTH):
                row[b] += strength * phi_y[j, b]


@njit(error_model="numpy", fastmath={"contract", "reassoc"})
def _interpolate(first_x, phi_x, first_y, phi_y, values, out):
    for i in range(out.shape[1]):
        for field in range(out.shape[0]):
            total = 0.0
            for a in range(WIDTH):
                row = values[field, first_x[i] + a, first_y[i] : first_y[i] + WIDTH]
                part = 0.0
                for b in range(WIDTH):
                    part += row[b] * phi_y[i, b]
                total += phi_x[i, a] * part
            out[field, i] = total
