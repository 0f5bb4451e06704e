"""The random walk: Levy flights with exact increments, the contrast at the end of Sec. 4.1.

A walker moves by independent symmetric stable increments,

    X(t + dt) = X(t) + (D dt)^(1/alpha) S,        E exp(i k S) = exp(-|k|^alpha),

S of density L_alpha^0. The sum of two increments over dt/2 has the law of one over dt, so that walkers which
start at 0 have the density G(x, D t) of (36) exactly, for any number of steps: all the error is statistical.

With V uniform on (-pi/2, pi/2) and W exponential of mean 1,

    S = sin(alpha V) / cos(V)  (W cos(V) / cos((alpha - 1) V))^((alpha - 1)/alpha),

Chambers, Mallows and Stuck (1976), J. Amer. Statist. Assoc. 71, 340-344, the symmetric case.

All functions raise `InvalidInput` if an argument is outside its range.
"""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln, xlog1py, xlogy

from fracparticles import arguments as check
from fracparticles._compiled import njit
from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.special.stable import green, tail_mass

__all__ = [
    "cell_counts",
    "cell_masses",
    "distribution",
    "expected_deviation",
    "kolmogorov_smirnov",
    "stable_variates",
    "walk",
]

_NARROW = 1e-3  # cell, in units of the nearest length: the error of Simpson's rule is its fourth power / 2880
_CHUNK = 2**14  # walkers at a time: their random numbers stay in the cache
_ROUNDED = 0.02  # of the way that walkers go: what the round-off of their places may be
_MOST_WALKERS = 10**9  # beyond, the logarithms in `expected_deviation` lose digits


# --- the walk -------------------------------------------------------------------------------------


def stable_variates(alpha: float, size: int, generator: np.random.Generator) -> FloatArray:
    """Return `size` independent S with the density L_alpha^0; parameters and errors as for `walk`."""
    origin = np.zeros(check.positive_integer("size", size, most=check.MOST))
    return walk(origin, alpha, 1.0, generator)


def walk(
    x: Any,
    alpha: float,
    time: float,
    generator: np.random.Generator,
    steps: int = 1,
    diffusivity: float = 1.0,
) -> FloatArray:
    """Return where walkers at x are after `time`: x + sum over the steps of (D dt)^(1/alpha) S.

    Walkers at 0 end with the density G(x, D time). The same generator state gives the same walk. The sum is rounded by
    itself, and added to x at the end.

    Raises `InvalidInput` if an argument is outside its range, or (D dt)^(1/alpha) is beyond 1e-100 .. 1e100.

    Warns with `AccuracyWarning` if the places are so far from zero that they hold few digits of the walk.

    Parameters
    ----------
    x : array_like, shape (walkers,)
        Positions to start from; left as they are.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        Duration, in `steps` equal steps.
    generator : numpy.random.Generator
        The source of random numbers.
    steps : int
        Number of steps; the law of the end does not depend on it.
    diffusivity : float
        D of Eq. (2).
    """
    start = check.positions("x", x)
    alpha = check.fractional_order(alpha)
    time, diffusivity = check.scale("time", time), check.scale("diffusivity", diffusivity)
    steps = check.positive_integer("steps", steps)
    generator = check.generator("generator", generator)
    # The logarithm of the scale, which itself may overflow.
    logarithm = (math.log(time) - math.log(steps) + math.log(diffusivity)) / alpha
    least, most = check.SIZES
    if not math.log(least) <= logarithm <= math.log(most):
        allowed = f"a time with (D dt)^(1/alpha) between {least:g} and {most:g}"
        raise InvalidInput("time", time, allowed, "Change the units of length or time.")
    _warn_of_round_off(start, math.exp(logarithm + math.log(steps) / alpha))
    gone = np.zeros_like(start)
    for first in range(0, gone.size, _CHUNK):
        part = gone[first : first + _CHUNK]
        uniform, exponential = np.empty_like(part), np.empty_like(part)
        for _ in range(steps):
            generator.random(out=uniform)
            generator.standard_exponential(out=exponential)
            _add_increments(part, math.exp(logarithm), alpha, uniform, exponential)
    return start + gone


def _warn_of_round_off(start: FloatArray, way: float) -> None:
    """Warn if half an ulp of the places is not small beside the way that walkers go, (D time)^(1/alpha)."""
    rounded = 0.5 * float(np.spacing(np.abs(start).max()))
    if rounded > _ROUNDED * way:
        warnings.warn(
            f"the walkers start so far from zero that their places are rounded by up to {rounded:.2g}, beside the "
            f"{way:.3g} that they go. Let them start near zero, and add the place to a number of more digits.",
            AccuracyWarning,
            stacklevel=3,
        )


@njit()
def _add_increments(x, scale, alpha, uniform, exponential):
    power = (alpha - 1.0) / alpha
    for i in range(x.size):
        # cos(v) > 0 for every double: at u = 0, -pi/2 in double precision, it is 6e-17.
        v = math.pi * (uniform[i] - 0.5)
        cosine = math.cos(v)
        ratio = exponential[i] * cosine / math.cos((alpha - 1.0) * v)
        x[i] += scale * math.sin(alpha * v) / cosine * ratio**power


# --- the density of walkers, and the exact one ----------------------------------------------------


def cell_counts(x: Any, half_width: float, cells: int, ensembles: int = 1) -> NDArray[np.int64]:
    """Count the walkers in equal cells of [-half_width, half_width), for disjoint ensembles: shape (ensembles, cells).

    Parameters
    ----------
    x : array_like, shape (walkers,)
        Positions; the ensembles are consecutive parts of equal size, a remainder is left out.
    half_width : float
        Half-width of the interval.
    cells : int
        Number of cells.
    ensembles : int
        Number of ensembles, at most that of walkers.
    """
    x, half_width = check.positions("x", x), check.scale("half_width", half_width)
    cells = check.positive_integer("cells", cells)
    ensembles = check.positive_integer("ensembles", ensembles)
    if ensembles > x.size:
        allowed = f"at most the {x.size} walkers"
        raise InvalidInput("ensembles", ensembles, allowed, "Take fewer ensembles.")
    if cells * ensembles > check.MOST:
        raise InvalidInput("cells", cells, f"at most {check.MOST} of all ensembles", "Take fewer.")
    counts = np.zeros((ensembles, cells), dtype=np.int64)
    _count(x, half_width, 0.5 * cells / half_width, counts)
    return counts


@njit()
def _count(x, half_width, cells_per_length, counts):
    ensembles, cells = counts.shape
    size = x.size // ensembles
    for e in range(ensembles):
        for i in range(e * size, (e + 1) * size):
            if -half_width <= x[i] < half_width:
                # Next to the end the place may be rounded up to the number of cells.
                place = int((x[i] + half_width) * cells_per_length)
                counts[e, min(place, cells - 1)] += 1


def cell_masses(edges: Any, t: float, alpha: float) -> FloatArray:
    """Return int G(x, t) dx over each cell, the probability p of a walker to be in it, shape (cells,).

    Parameters
    ----------
    edges : array_like, shape (cells + 1,)
        The edges, rising; they may be infinite.
    t : float
        Time, t > 0.
    alpha : float
        Fractional order, 1 < alpha < 2.
    """
    edges = check.real_array("edges", edges)
    if edges.ndim != 1 or edges.size < 2 or not (edges[1:] > edges[:-1]).all():
        raise InvalidInput("edges", edges, "two or more rising numbers", "Sort them.")
    beyond = 0.5 * np.asarray(tail_mass(np.abs(edges), t, alpha))
    left, right = beyond[:-1], beyond[1:]
    # Differences of the tail on either side of 0: those of the distribution would cancel there.
    one_sided = np.where(edges[:-1] >= 0.0, left - right, right - left)
    mass = np.where((edges[:-1] < 0.0) & (edges[1:] > 0.0), 1.0 - left - right, one_sided)
    width = edges[1:] - edges[:-1]
    narrow = width < _NARROW * (t ** (1.0 / alpha) + np.abs(edges[:-1]))
    if narrow.any():
        # Of a narrow cell the difference has few digits; Simpson's rule has all.
        low, high = edges[:-1][narrow], edges[1:][narrow]
        density = (
            green(low, t, alpha) + 4.0 * green(0.5 * (low + high), t, alpha) + green(high, t, alpha)
        )
        mass[narrow] = width[narrow] / 6.0 * density
    return mass


def distribution(x: Any, t: float, alpha: float) -> FloatArray:
    """Return F(x, t), the integral of G from minus infinity to x."""
    x = check.real_array("x", x)
    beyond = 0.5 * np.asarray(tail_mass(np.abs(x), t, alpha))
    return np.where(x < 0.0, beyond, 1.0 - beyond)


def kolmogorov_smirnov(x: Any, t: float, alpha: float) -> float:
    """Return max |F_n(x) - F(x, t)|, F_n the share of the n walkers to the left of x."""
    exact = distribution(np.sort(check.positions("x", x)), t, alpha)
    steps = np.arange(exact.size + 1) / exact.size
    return float(max((steps[1:] - exact).max(), (exact - steps[:-1]).max()))


def expected_deviation(masses: Any, walkers: int) -> FloatArray:
    """Return E |N/n - p| for the number N of n independent walkers in a cell of mass p.

    With m the whole part of n p, plus 1, it is 2 (m/n) (n over m) p^m (1 - p)^(n - m + 1) (de Moivre 1730),
    for large n p the square root of 2 p (1 - p) / (pi n).

    Parameters
    ----------
    masses : array_like
        p, within [0, 1], any shape, which the result has.
    walkers : int
        n, at most 1e9.
    """
    p, n = check.within("masses", masses, 0.0, 1.0), check.positive_integer("walkers", walkers)
    if n > _MOST_WALKERS:
        remedy = "Use the square root of 2 p (1 - p)/(pi n)."
        raise InvalidInput("walkers", n, f"at most {_MOST_WALKERS:g}", remedy)
    m = np.minimum(np.floor(n * p) + 1.0, n)  # p = 1 gives 0 either way
    logarithm = gammaln(n + 1.0) - gammaln(m + 1.0) - gammaln(n - m + 1.0)
    logarithm += xlogy(m, p) + xlog1py(n - m + 1.0, -p)
    return 2.0 * m / n * np.exp(logarithm)
