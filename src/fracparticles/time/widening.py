"""A run on the whole space over any time, on a lattice that widens with the solution.

After the time t the waves of a solution have decayed by exp(-D t |k|^alpha): a lattice of twice the spacing holds it to
nine digits once

    D t (pi / 2 h)^alpha >= E,   exp(-E) the part that is let go.

Then every second point is left out, and as many points as before reach twice as far. Between the old ends and the new
ones the same step computes the solution from the powers that continue it (`time.whole_space`). In units of the spacing
the steps from one doubling to the next are all the same step, whose transforms are made ready once. With each doubling
the time grows by the factor 2^alpha, so that a run of a million units of time takes some twenty of them.

The tail is fitted to the data once, about their centre. After that it is carried from step to step, as it follows from
the moments. A tail fitted anew after each doubling would grow with the doublings, near alpha = 1 beyond all bounds.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import next_fast_len

from fracparticles import arguments as check
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.time.continued import Continued
from fracparticles.time.exponents import later_exponents, powers, tail_exponents
from fracparticles.time.labels import check_labels
from fracparticles.time.short_waves import ShortWaves
from fracparticles.time.whole_space import FEWEST

__all__ = ["evolve_long"]

_LET_GO = 20.0  # E: exp(-E) is 2e-9
_STRETCH = 2.1  # length of the circle of the transforms over that of the lattice; the widened lattice takes 2 of it
_TERMS = {1: 5, 2: 4, 3: 2}  # powers that continue the data, by dimension
# Estimates above these are warned of. Measured against exact solutions, the first is two to a hundred times the error,
# the second two to fifty times, and the third is at least the error.
_SHORT_WAVES = 1e-5  # of the integral: what the lattice does not resolve
_OF_A_PEAK = 5e-5  # of the greatest value, before the first doubling: likewise
_DOUBTFUL = 2e-6  # of the integral, or of the greatest value: what the powers leave open
_GREATEST = 5.0  # the largest gamma of a tail |x|^(-n-gamma) that is carried on
_SHORTEST = 1e-12  # scaled time of a step that only moves the solution
_TINY = float(np.finfo(float).tiny)
_ROUND_OFF = float(np.finfo(float).eps)
_CANCELLED = 10.0  # int |u| over what is left of it: less is no cancellation
# Half the lattice over the spread at a doubling: measured, less loses the sixth digit.
_NARROW = 10.0


class _Unknown(NamedTuple):
    """int |u|, and what is not known of int u and int x u, in units of the spacing."""

    size: float
    of_mass: float
    of_first: float


def evolve_long(
    u: ArrayLike,
    spacing: float,
    alpha: float,
    time: float,
    *,
    diffusivity: float = 1.0,
    tail: Sequence[float] | None = None,
) -> tuple[np.ndarray, float]:
    """Return the solution of u_t = -D (-Laplacian)^(alpha/2) u after a time, and the spacing of its lattice.

    Parameters
    ----------
    u : array, shape (N, .., N), one to three axes
        Values at x_i = (i - N // 2) h along each axis; integrable on the whole space. The powers start at the centre
        of |u|. The coordinates of labelled data must be the spacing apart.
    spacing : float
        h.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        The time to go, however long; after none the solution is the data.
    diffusivity : float
        D.
    tail : sequence of float, optional
        The powers by which the data fall, see `evolve`.

    Returns
    -------
    u : array
        Of the same shape: values at x_i = (i - N // 2) H.
    H : float
        h times a power of two.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.

    Warns
    -----
    AccuracyWarning
        If more than some 1e-5 of the greatest value may be wrong: the powers do not say what lies beyond the lattice,
        or it does not resolve the data; or data of both signs have cancelled down to what is not known of their
        integral and their first moment.

    Examples
    --------
    >>> x = (np.arange(800) - 400) * 0.1
    >>> u, h = evolve_long(np.exp(-x * x), 0.1, alpha=1.5, time=1.0e6, tail=())
    """
    given, u = u, check.finite_array("u", u)
    alpha, h = check.fractional_order(alpha), check.scale("spacing", spacing)
    left = check.time_to_go(time) * check.scale("diffusivity", diffusivity)  # D t
    if u.ndim not in (1, 2, 3) or len(set(u.shape)) != 1:
        raise InvalidInput(
            "u", u.shape, "as many points along each of one to three axes", "Pad it."
        )
    points, dim = check.whole_number("points", u.shape[0], FEWEST), u.ndim
    check_labels(given, dim, h)
    before = tail_exponents(alpha, _TERMS[dim]) if tail is None else powers(tail, dim)
    if not left:
        return u.copy(), h
    exponent = int(np.frexp(np.abs(u).max(initial=0.0))[1])
    # Of order one: sums of the greatest numbers would overflow.
    u = np.asarray(np.ldexp(u, -exponent))
    doubling = _LET_GO * (2.0 / np.pi) ** alpha  # D t / h^alpha at which the spacing doubles
    middle = _middle(u)
    after = later_exponents(before, alpha, max([_GREATEST, *before]))
    first = partial(
        _step, points, dim, alpha, before=before, after=after, middle=middle, outer=True
    )
    if left <= doubling * h**alpha:
        scaled = max(left * h**-alpha, _SHORTEST)
        u = _begun(first(scaled, moved=None), u, lambda waves: waves.of_a_peak(alpha, scaled)[0])[0]
        return np.ldexp(u, exponent), h
    spread = left / h**alpha + (0.5 * points) ** alpha  # of what lies beyond the lattice
    _warn_of_few_points(points, 2.0 * _NARROW * doubling ** (1.0 / alpha))
    u, b, unknown = _begun(first(doubling, every=2), u)
    moved = -h * np.array(middle)  # back to the middle of the lattice that was given
    left, h = left - doubling * h**alpha, 2.0 * h
    between = doubling * (1.0 - 2.0**-alpha)
    later = partial(_step, points, dim, alpha, before=after, after=after)
    if left > between * h**alpha:
        widen = later(between, every=2)
        while left > between * h**alpha:
            u, b = _onward(widen, u, b)
            left, h = left - between * h**alpha, 2.0 * h
    last = later(max(left * h**-alpha, _SHORTEST), moved=(moved / h).tolist())
    u = _onward(last, u, b)[0]
    _warn_of_what_cancels(u, unknown, spread, alpha)
    return np.ldexp(u, exponent), h


def _step(points: int, *given: Any, every: int = 1, **more: Any) -> Continued:
    """Return a run on a circle some twice as long as the lattice; see `Continued`."""
    half = 2 * every  # the circle keeps every `every`-th point, an even number of them
    length = half * next_fast_len(-(-int(_STRETCH * points) // half), real=True)
    return Continued(points, length, *given, every=every, **more)


def _begun(
    step: Continued, u: np.ndarray, of_a_peak: Callable[[ShortWaves], float] | None = None
) -> tuple[np.ndarray, np.ndarray, _Unknown]:
    """Return the result of the first step, the amplitudes of its tail, and what is not known of the moments.

    Warns if the data are not what the step takes; with `of_a_peak` also if waves that the lattice lacks are there yet.
    """
    seen: list[np.ndarray] = []
    result, numbers = step(u[None], look=seen.append)
    waves, greatest = step.waves(seen[0]), float(np.abs(seen[0]).max())
    missed = float(waves.of_the_integral[0])
    _warn_of_short_waves(missed / (greatest + _TINY), "their integral", _SHORT_WAVES)
    if of_a_peak is not None:
        peak = float(np.abs(result).max()) + _TINY
        _warn_of_short_waves(of_a_peak(waves) / peak, "the greatest value", _OF_A_PEAK)
    size, length = float(np.abs(u).sum()), float(step.length)
    of_mass, of_first = step.tails.meeting.left_open(u)
    of_mass, of_first = of_mass * length**u.ndim, of_first * length ** (u.ndim + 1)
    _warn_of_tails(of_mass / (size + _TINY), len(u))
    # The estimate of what the lattice lacks is so many times larger than the error; that of the powers is not.
    of_mass += missed * (_DOUBTFUL / _SHORT_WAVES) + _ROUND_OFF * size
    return result[0], step.amplitudes(numbers), _Unknown(size, of_mass, of_first)


def _onward(step: Continued, u: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the result and the amplitudes of its tail, from those of the data."""
    result, numbers = step(u[None], b)
    return result[0], step.amplitudes(numbers)


def _warn_of_few_points(points: int, least: float) -> None:
    """Warn if the solution at a doubling is too wide for the lattice."""
    if points < least:
        warnings.warn(
            f"a lattice of {points} points an axis loses digits as it widens: the powers that continue the solution "
            f"meet it too near. Take {int(np.ceil(least))}, with the same spacing.",
            AccuracyWarning,
            stacklevel=3,
        )


def _warn_of_short_waves(lacking: float, what: str, limit: float) -> None:
    """Warn if the lattice does not hold the data: then their sum is not their integral, for ever, or a peak is off."""
    if lacking > limit:
        warnings.warn(
            f"the lattice does not resolve the data: up to {min(1.0, lacking):.2g} of {what} may be missed. Take a "
            "smaller spacing, if they are samples of something finer.",
            AccuracyWarning,
            stacklevel=4,
        )


def _warn_of_tails(doubt: float, points: int) -> None:
    """Warn if the powers do not say what lies beyond the lattice."""
    if doubt > _DOUBTFUL:
        warnings.warn(
            f"the powers that continue the data beyond the lattice of {points} points an axis leave up to {doubt:.2g} "
            "of their integral open. Take a wider lattice, with the same spacing; or say by which powers they fall: "
            "tail=() for data that end.",
            AccuracyWarning,
            stacklevel=4,
        )


def _warn_of_what_cancels(u: np.ndarray, unknown: _Unknown, spread: float, alpha: float) -> None:
    """Warn if the data have cancelled down to what is not known of their integral or of their first moment.

    In units of the first spacing. An integral m spreads to m G <= m P_0, a first moment to its product with the
    gradient of G, at most m P_1;
    P_l = (2 pi)^-n int |k|^l exp(-t |k|^alpha) dk = S_n Gamma((n + l) / alpha) t^(-(n + l) / alpha) / (alpha (2 pi)^n).
    """
    n = u.ndim
    surface = 2.0 * math.pi ** (0.5 * n) / math.gamma(0.5 * n)
    wrong = sum(
        moment
        * math.gamma((n + degree) / alpha)
        * spread ** (-(n + degree) / alpha)
        * surface
        / (alpha * (2.0 * math.pi) ** n)
        for degree, moment in enumerate((unknown.of_mass, unknown.of_first))
    )
    doubt = min(1.0, wrong / (float(np.abs(u).max()) + _TINY))
    before = unknown.of_mass / (unknown.size + _TINY)  # which has been said
    if doubt > max(_DOUBTFUL, _CANCELLED * before):
        warnings.warn(
            f"the data cancel: what is left of them may be off by {doubt:.2g} of its greatest value, since the lattice "
            "and the powers beyond it do not say their integral and their first moment any better. Take a wider "
            "lattice, with the same spacing; or tail=() for data that end.",
            AccuracyWarning,
            stacklevel=3,
        )


def _middle(u: np.ndarray) -> list[int]:
    """Return the centre of |u|, where the powers start, in points from the middle of the lattice."""
    size, found = np.abs(u), []
    for axis in range(u.ndim):
        line = size.sum(axis=tuple(other for other in range(u.ndim) if other != axis))
        place = np.arange(line.size) - line.size // 2
        found.append(int(np.rint((line @ place) / max(line.sum(), _TINY))))
    return found
