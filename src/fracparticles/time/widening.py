"""A run on the whole space over any time, on a lattice that widens with the solution.

After the time t the waves of a solution have decayed by exp(-D t |k|^alpha): a lattice of twice the spacing holds it to
nine digits once

    D t (pi / 2 h)^alpha >= E,   exp(-E) the part that is let go.

Then every second point is left out, and as many points as before reach twice as far. What lies between the old ends and
the new ones is what the powers that continue the solution make of it in the same step (`time.whole_space`). In units of
the spacing all steps between two such doublings are one step, whose transforms are made ready once; the time grows by
the factor 2^alpha with each, so that a run of a million units of time takes some twenty of them.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fracparticles.arguments import finite_array, fractional_order, positive_real
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.time.exponents import later_powers
from fracparticles.time.whole_space import WholeSpace

__all__ = ["evolve_long"]

_LET_GO = 20.0  # E: 2e-9
_STRETCH = 2.5  # the circle of the transforms over the lattice; twice the lattice is wanted of it
_TERMS = {1: 5, 2: 4, 3: 2}
_SHORTEST = 1e-12  # scaled time of a step that only moves the solution
_TINY = float(np.finfo(float).tiny)
_NARROW = 16.0  # half the lattice over the spread at a doubling: less loses digits


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
        Values at x_i = (i - N // 2) h along each axis; integrable on the whole space. In the plane and in space the
        middle of the data should be near that of the lattice: the powers start there.
    spacing : float
        h.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        The time to go, however long.
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
        If the lattice is too narrow for six digits: it takes some hundred points along each axis.

    Examples
    --------
    >>> x = (np.arange(800) - 400) * 0.1
    >>> u, h = evolve_long(np.exp(-x * x), 0.1, alpha=1.5, time=1.0e6, tail=())
    """
    u = finite_array("u", u)
    alpha, h = fractional_order(alpha), positive_real("spacing", spacing)
    left = positive_real("time", time) * positive_real("diffusivity", diffusivity)  # D t
    if u.ndim not in (1, 2, 3) or len(set(u.shape)) != 1:
        raise InvalidInput(
            "u", u.shape, "as many points along each of one to three axes", "Pad it."
        )
    points, dim = u.shape[0], u.ndim
    doubling = _LET_GO * (2.0 / np.pi) ** alpha  # D t / h^alpha at which the spacing doubles
    middle = _middle(u)
    if left <= doubling * h**alpha:
        return _step(points, dim, alpha, left * h**-alpha, tail, middle=middle).solve(u), h
    if 0.5 * points < _NARROW * doubling ** (1.0 / alpha):
        least = int(np.ceil(2.0 * _NARROW * doubling ** (1.0 / alpha)))
        warnings.warn(
            f"a lattice of {points} points an axis loses digits as it widens: the powers that continue the solution "
            f"meet it too near. Take {least}, with the same spacing.",
            AccuracyWarning,
            stacklevel=2,
        )
    u = _step(points, dim, alpha, doubling, tail, wider=2, middle=middle).solve(u)
    moved = -h * np.array(middle)  # back to the middle of the lattice that was given
    left, h = left - doubling * h**alpha, 2.0 * h
    after = None if tail is None else later_powers(tail, dim, alpha, _TERMS[dim])
    between = doubling * (1.0 - 2.0**-alpha)
    widen = _step(points, dim, alpha, between, after, wider=2) if left > between * h**alpha else None
    while widen is not None and left > between * h**alpha:
        u = widen.solve(u)
        left, h = left - between * h**alpha, 2.0 * h
    last = max(left * h**-alpha, _SHORTEST)
    return _step(points, dim, alpha, last, after, moved=moved / h).solve(u), h


def _step(
    points: int,
    dim: int,
    alpha: float,
    scaled_time: float,
    tail: Sequence[float] | None,
    **places: Any,
) -> WholeSpace:
    return WholeSpace(
        points, dim, alpha, scaled_time,
        terms=_TERMS[dim], tail=tail, stretch=_STRETCH, outer=True, **places,
    )  # fmt: skip


def _middle(u: np.ndarray) -> list[int]:
    """Return the centre of |u|, where the powers start, in points from the middle of the lattice."""
    size, found = np.abs(u), []
    for axis in range(u.ndim):
        line = size.sum(axis=tuple(other for other in range(u.ndim) if other != axis))
        place = np.arange(line.size) - line.size // 2
        found.append(int(np.rint((line @ place) / max(line.sum(), _TINY))))
    return found
