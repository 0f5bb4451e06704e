"""Smooth particles (9), the derivative as an integral operator (18), and its sum over particles (21).

A kernel of twice the radius errs at least four times as much if its error is like eps^2, and more for a higher order.
So a third of the change of the result by twice the radius bounds the error of the smoothing. A large one is warned of.

Each term of the sum is rounded, and its z by the rounding of the places over eps. A derivative of order beta has terms
like f / eps^beta, of which nearly all cancels: with eps = 3e-5, no digit of a fourth derivative is left.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.pse.moments import nodes_and_weights, warn_of_moment
from fracparticles.pse.shapes import Kernel, kernel_of

__all__ = ["derivative", "lattice", "reconstruct", "regularised"]

_MOST_PARTICLES = 2**26  # of a lattice: half a gigabyte
_FARTHEST = 2.0**31  # distance of a lattice from the origin, in h
_MOST_PAIRS = 2**25  # of points and particles
_HIGHEST = 24  # order of a derivative
_EPS = float(np.finfo(float).eps)
_ROUND_OFF = 64.0 * _EPS  # share of the sum of the sizes of all terms
_WRONG = 0.05  # share of the largest value: a larger error by the smoothing is warned of
_DIGITS = 1e-9  # of the variation of f: what changes f by less is zero but for round-off
_ELSEWHERE = 32  # particles at which a result is compared, as it may be zero where it is asked for
_SEEN = 3.0  # radii: particles farther away count little in any kernel
_WHOLE = 0.75, 1.5  # ratio of the moments at twice the radius and at one, where there are no gaps


class _Sums(NamedTuple):
    """At each point: the sum over the particles, the moment that must be 1, the size of the terms, their round-off."""

    result: FloatArray
    moment: FloatArray
    sizes: FloatArray
    round_off: FloatArray


def lattice(low: float, high: float, h: float) -> FloatArray:
    """Return the particles i h from the last below `low` to the first above `high`.

    Raises `InvalidInput` if h is not positive, `high` is below `low`, or too many particles would be needed.
    """
    h = check.scale("h", h)
    low = check.real_between("low", low, -_FARTHEST * h, _FARTHEST * h)
    high = check.real_between("high", high, low, _FARTHEST * h)
    if not (high - low) / h < _MOST_PARTICLES:
        raise InvalidInput("h", h, f"at most {_MOST_PARTICLES} particles", "Take a larger h.")
    return h * np.arange(np.floor(low / h), np.ceil(high / h) + 1.0)


def reconstruct(
    x: ArrayLike,
    particles: ArrayLike,
    values: ArrayLike,
    volumes: ArrayLike,
    epsilon: float,
    kernel: Kernel,
) -> FloatArray:
    """f_eps^h(x) = sum_p f(x_p) V_p eta_eps(x - x_p)  (9), shape (M,).

    Raises `InvalidInput` if the arrays do not fit together or are not finite, or epsilon or the kernel is not allowed.

    Warns with `AccuracyWarning` if epsilon is too large for the field.

    Parameters
    ----------
    x : array_like, shape (M,)
        The points at which the sum is wanted.
    particles, values : array_like, shape (N,)
        x_p and f(x_p), real or complex.
    volumes : array_like, shape (N,) or ()
        V_p.
    epsilon : float
        Kernel radius, positive.
    kernel : Kernel
        eta, of one dimension.
    """
    x, particles = check.positions("x", x, least=0), check.positions("particles", particles)
    values = check.vector("values", values, particles.size, complex_too=True)

    def sums(radius: float) -> _Sums:
        weights = _matrix(x, particles, volumes, radius, kernel)
        sizes = np.abs(weights) @ np.abs(values)
        return _Sums(weights @ values, weights.sum(axis=1), sizes, np.zeros(x.size))

    with np.errstate(all="ignore"):
        found = sums(epsilon)
        check.finite_result("values", found.result)
        _warn_of_smoothing(found, sums, _inside(x, particles, epsilon, kernel), epsilon)
    return found.result


def derivative(
    x: ArrayLike,
    at: ArrayLike,
    particles: ArrayLike,
    values: ArrayLike,
    volumes: ArrayLike,
    epsilon: float,
    kernel: Kernel,
    order: int,
) -> FloatArray:
    """eps^-beta sum_p [f(x_p) - f(x)] V_p eta_eps(x - x_p), shape (M,), the sum of (18); (21) for beta = 2.

    Errors as for `reconstruct`; also if the order is not a whole number from 1 to 24.

    Warns with `AccuracyWarning` if the particles near some of the points give far less or far more than one for the
    moment sum_p V_p (x_p - x)^beta eta_eps(x - x_p) / (beta! eps^beta), which must be one. Warns with it, too, if
    round-off is more than a twentieth of the result, or epsilon is too large for the field; of a stencil the latter
    cannot be known.

    Parameters
    ----------
    x, at : array_like, shape (M,)
        The points, and f at them.
    order : int
        beta, at most 24.
    particles, values, volumes, epsilon, kernel
        As in `reconstruct`.
    """
    order = check.whole_number("order", order, least=1, most=_HIGHEST)
    x, particles = check.positions("x", x, least=0), check.positions("particles", particles)
    values = check.vector("values", values, particles.size, complex_too=True)
    at = check.vector("at", at, x.size, least=0, complex_too=True)

    def sums(radius: float, x: FloatArray = x, at: np.ndarray = at) -> _Sums:
        divisor = _power(radius, order)
        weights = _matrix(x, particles, volumes, radius, kernel)
        differences = values - at[:, None]
        result = (weights * differences).sum(axis=1) / divisor
        z = np.where(weights == 0.0, 0.0, (particles - x[:, None]) / radius)
        moment = np.einsum("ij,ij->i", weights, z**order) / math.factorial(order)
        sizes = np.abs(weights) @ np.abs(values) + np.abs(weights).sum(axis=1) * np.abs(at)
        unit = float(sizes.max(initial=0.0)) or 1.0  # squares in the caller's may be no numbers
        # Of each value, of f(x) in all terms, and of the places, which a kernel like z^beta takes beta times.
        apart = order * float(np.spacing(np.abs(particles).max())) / radius
        parts = (
            0.5 * _EPS * np.abs(weights * (values / unit)),
            0.5 * _EPS * np.abs(weights.sum(axis=1) * (at / unit))[:, None],
            apart * np.abs(weights * (differences / unit)),
        )
        noise = unit * np.sqrt(sum(np.square(part).sum(axis=1) for part in parts))
        return _Sums(result, moment, sizes / divisor, noise / divisor)

    with np.errstate(all="ignore"):
        found = sums(epsilon)
        check.finite_result("values", found.result)
        warn_of_moment(found.moment, "points", stacklevel=2)
        inner = np.flatnonzero(_inside(particles, particles, epsilon, kernel))
        some = inner[:: max(1, inner.size // _ELSEWHERE)]
        elsewhere = partial(sums, epsilon, particles[some], values[some])
        varies = float(np.abs(values - values.mean()).max())
        extent = float(np.ptp(particles)) / epsilon
        if varies > _ROUND_OFF * float(np.abs(values).max()) and extent > 0.0:
            least = _DIGITS * varies / extent**order / _power(epsilon, order)
            _warn_of_round_off(found, elsewhere, least)
        _warn_of_smoothing(found, sums, _inside(x, particles, epsilon, kernel), epsilon)
    return found.result


def regularised(
    f: Callable[[FloatArray], FloatArray], x: ArrayLike, epsilon: float, kernel: Kernel, order: int
) -> FloatArray:
    """eps^-beta int [f(x - eps z) - f(x)] eta(z) dz, the integral (18), shape (M,); for beta = 0 the integral of (9).

    This is the sum without its quadrature error: its difference from the derivative is the regularisation error.

    Parameters and errors as for `derivative`, with f a function of x; also if f does not take arrays, or is not finite.
    """
    divisor = _power(epsilon, check.whole_number("order", order, most=_HIGHEST))
    x = check.positions("x", x, least=0)
    z, w = nodes_and_weights(kernel)
    _check_pairs(x.size, z.size)
    shifted = check.sampled("f", f, x[:, None] - epsilon * z)
    with np.errstate(all="ignore"):
        if order > 0:
            shifted = shifted - check.sampled("f", f, x)[:, None]
        return check.finite_result("f", shifted @ (w * kernel(z)) / divisor)


def _inside(x: FloatArray, particles: FloatArray, epsilon: float, kernel: Kernel) -> np.ndarray:
    """Whether there are particles on both sides of each point as far as a kernel of twice the radius reaches."""
    seen = 2.0 * epsilon * min(kernel.reach, _SEEN)
    return (x - seen >= particles.min()) & (x + seen <= particles.max())


def _warn_of_smoothing(
    found: _Sums, sums: Callable[[float], _Sums], inside: np.ndarray, epsilon: float
) -> None:
    """Warn if twice the radius changes a result, over its moment, by more than three times the error allowed."""
    try:
        wider = sums(2.0 * epsilon)
    except InvalidInput:  # a stencil has one radius only, and lengths end at 1e100
        return
    ratio = wider.moment / found.moment
    whole = inside & (ratio > _WHOLE[0]) & (ratio < _WHOLE[1])
    change = np.where(whole, np.abs(wider.result / ratio - found.result), 0.0) / 3.0
    most, largest = (float(np.abs(a).max(initial=0.0)) for a in (change, found.result))
    if most > _WRONG * largest + _ROUND_OFF * float(found.sizes.max(initial=0.0)):
        warnings.warn(
            "epsilon is too large for the field: the smoothing changes the result by about "
            f"{most / max(most, largest):.2g} of its largest value. Take a smaller epsilon, or a kernel of higher "
            "order.",
            AccuracyWarning,
            stacklevel=3,
        )


def _warn_of_round_off(found: _Sums, elsewhere: Callable[[], _Sums], least: float) -> None:
    """Warn if round-off is a large share of the results, and more than `least`."""
    rounded = float(found.round_off.max(initial=0.0))
    largest = float(np.abs(found.result).max(initial=0.0))
    if rounded > max(_WRONG * largest, least):
        largest = max(largest, float(np.abs(elsewhere().result).max(initial=0.0)))
    if rounded > max(_WRONG * largest, least):
        warnings.warn(
            f"round-off changes the result by about {rounded / max(rounded, largest):.2g} of its largest value: much "
            "larger terms cancel. Take a larger epsilon, an origin that is nearer, or a derivative of lower order.",
            AccuracyWarning,
            stacklevel=3,
        )


def _matrix(
    x: ArrayLike, particles: ArrayLike, volumes: ArrayLike, epsilon: float, kernel: Kernel
) -> FloatArray:
    """V_p eta_eps(x - x_p), shape (M, N)."""
    epsilon, kernel = check.scale("epsilon", epsilon), kernel_of(1, kernel)
    x, particles = check.positions("x", x, least=0), check.positions("particles", particles)
    volumes = check.finite_array("volumes", volumes)
    if volumes.ndim:
        volumes = check.vector("volumes", volumes, particles.size)
    _check_pairs(x.size, particles.size)
    z = (x[:, None] - particles) / epsilon
    with np.errstate(over="ignore"):
        return kernel(z) * check.finite_result("volumes", volumes / epsilon)


def _check_pairs(points: int, particles: int) -> None:
    if points * particles > _MOST_PAIRS:
        shown = f"{points} points for {particles} particles"
        raise InvalidInput("x", shown, f"at most {_MOST_PAIRS} pairs", "Do it in parts.")


def _power(epsilon: float, order: int) -> float:
    epsilon = check.scale("epsilon", epsilon)
    if abs(order * math.log10(epsilon)) > 300.0:
        allowed = f"a number whose power {order} does not overflow"
        raise InvalidInput("epsilon", epsilon, allowed, "Change the units.")
    return float(epsilon**order)
