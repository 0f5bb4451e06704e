r"""The fractional operators without kernels, and a warning if the SPH sums differ from them.

They are computed by product integration, with the central difference of fourth order for f':

    I^alpha f    = int_a^x (x-x')^(alpha-1) f(x') dx' / Gamma(alpha),
    C D^alpha f  = int_a^x (x-x')^(-alpha) f'(x') dx' / Gamma(1-alpha),
    RL D^alpha f = f(a) (x-a)^(-alpha) / Gamma(1-alpha) + C D^alpha f + alpha'(x) d/dalpha I^(1-alpha) f,

with the last term only for a variable order. Where the particles resolve a field, these operators err far less than the
sums over smooth particles, and the difference is the error of the sums. Where they do not, the two disagree. With few
particles the broken line would be the worse of the two: the field is then its cubic spline, virtual particles included,
on four times as many.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import gamma

from fracparticles.errors import AccuracyWarning
from fracparticles.sph.integrals import COMPLETED
from fracparticles.sph.particles import ParticleLine
from fracparticles.sph.product_integration import fractional_integral

__all__ = ["among_more", "caputo_derivative", "rl_derivative", "rl_integral", "warn_of_difference"]

Other = Callable[[ParticleLine, np.ndarray, np.ndarray], np.ndarray]

_WRONG = 0.05  # share of the largest value: a larger difference is warned of
_STEP = 1e-4  # in alpha, for the derivative by the order
# Up to so many particles the broken line errs too much itself, and is taken on so many times as many.
_FEW, _FINER = 32, 4
_ROUND_OFF = 16.0 * float(np.finfo(float).eps)  # of a difference of values, relative


def rl_integral(line: ParticleLine, f: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """I^alpha f on the real particles, shape (N,).

    The field and the order are given on all particles, as for the other operators.
    """
    return fractional_integral(f[line.inside], line.spacing, alpha[line.inside])


def caputo_derivative(line: ParticleLine, f: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """C D^alpha f."""
    return fractional_integral(_slope(line, f), line.spacing, 1.0 - alpha[line.inside])


def rl_derivative(line: ParticleLine, f: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """RL D^alpha f, infinite at a unless f(a) = 0."""
    derivative = caputo_derivative(line, f, alpha)
    at_a, order = f[line.inside.start], alpha[line.inside]
    if at_a != 0.0:
        with np.errstate(divide="ignore"):
            derivative += at_a * (line.x - line.a) ** -order / gamma(1.0 - order)
    if alpha.min() < alpha.max():
        higher, lower = (rl_integral(line, f, 1.0 - alpha - step) for step in (_STEP, -_STEP))
        derivative += _slope(line, alpha) * (higher - lower) / (2.0 * _STEP)
    return derivative


def among_more(other: Other, line: ParticleLine, f: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """One of these operators on the real particles; of few by the spline through the field on four times as many."""
    if line.count > _FEW:
        return other(line, f, alpha)
    finer = replace(line, count=(line.count - 1) * _FINER + 1)
    # Virtual ones lie as many of the smaller spacings beyond the ends; places are told by that of the real ones.
    places = (np.arange(finer.x_all.size) - finer.margin) / _FINER + line.margin
    i = np.arange(f.size)
    with np.errstate(all="ignore"):
        scale = np.abs(f).max() or 1.0
        values = scale * CubicSpline(i, f / scale)(places)
        return other(finer, values, np.interp(places, i, alpha))[::_FINER]


def warn_of_difference(
    line: ParticleLine, result: np.ndarray, other: np.ndarray, size: float, method: str
) -> None:
    """Warn if the real part of a result differs from another by more than 5 % of the largest value.

    Infinite values are left out.

    `size` is the result of the operator for the greatest |f| on the whole line; two differences lose N^2 round-off of
    it.
    """
    finite = np.isfinite(other) & np.isfinite(result)
    largest = float(np.abs(other[finite]).max(initial=0.0))
    error = np.where(finite, np.abs(result.real - np.where(finite, other, 0.0)), 0.0)
    if error.max() > _WRONG * largest + _ROUND_OFF * line.count**2 * size:
        instead = "" if method == COMPLETED else f", or method='{COMPLETED}'"
        share = error.max() / max(largest, error.max())
        warnings.warn(
            f"the result is wrong by about {share:.2g} of its largest value, most at x = "
            f"{line.x[error.argmax()]:g}. Take more particles{instead}.",
            AccuracyWarning,
            stacklevel=4,
        )


def _slope(line: ParticleLine, f: np.ndarray) -> np.ndarray:
    """[8 (f_{i+1} - f_{i-1}) - (f_{i+2} - f_{i-2})] / (12 s); two virtual particles are always there."""
    first, end = line.inside.start, line.inside.stop
    near, far = (f[first + k : end + k] - f[first - k : end - k] for k in (1, 2))
    return np.asarray((8.0 * near - far) / (12.0 * line.spacing))
