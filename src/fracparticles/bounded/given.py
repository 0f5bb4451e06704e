r"""Values outside a bounded domain that a caller gives, and that may depend on time.

The values g outside are taken off: u = w + v, where w has the values g outside. With the operator D A of the domain,
for any w

    v' = D A v + (D A w - w') + f,    v = 0 outside.

A domain returns w and D A w for g at one time, `lifted`. Where they change, both are interpolated by Chebyshev
polynomials of the time, whose derivative is w'.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.fft import dct

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.called import AXES, Called
from fracparticles.errors import InvalidInput, NonFiniteSolution

__all__ = [
    "RESOLVED",
    "Lift",
    "Outside",
    "given_outside",
    "lifted_in_time",
]

_FIRST, _LAST = 8, 512  # the first and the last degree that is tried
_MISSED = 1e-6  # the greatest miss at a sudden change over the greatest coefficient

RESOLVED = 1e-11
"""The last coefficients over the greatest, of polynomials that resolve g in time."""


class Outside(NamedTuple):
    """g(places, t) outside; `varies` says whether it depends on t."""

    at: Callable[..., Any]
    varies: bool


def given_outside(exterior: str, outside: Any, dim: int) -> Outside | None:
    """Return g from a function of places and time, of some of them, or a number; None if there is none.

    Raises
    ------
    InvalidInput
        If values are missing where the exterior is given, or given where it is not.
    """
    if (outside is None) == (exterior == "given"):
        allowed = "values of u outside if the exterior is given, nothing otherwise"
        raise InvalidInput("outside", outside, allowed, "Give g, or take another exterior.")
    if outside is None:
        return None
    if callable(outside):
        given = Called("outside", outside, (*AXES[:dim], "t"))
        return Outside(given, "t" in given.takes)
    value = check.finite_real("outside", outside)
    return Outside(lambda *place: np.full(np.shape(place[0]), value), False)


class Lift(NamedTuple):
    """w, D A w, grad^beta w (on an interval, for a diffusivity that varies) and w'."""

    base: FloatArray
    load: FloatArray
    flux: FloatArray
    slope: FloatArray


def lifted_in_time(
    lifted: Callable[[float], Lift],
    varies: bool,
    start: float,
    span: float,
    sudden: Sequence[float] = (),
) -> Callable[[float], Lift]:
    """Return a lift as a function of time, interpolated in time, and checked at the sudden times.

    Parameters
    ----------
    lifted : callable
        Returns the lift at a time.
    varies : bool
        Whether it depends on time.
    start, span : float
        The lift is valid from `start` to `start + span`.
    sudden : sequence of float
        The times before and after each sudden change.

    Raises
    ------
    NonFiniteSolution
        If the values vary too fast in time for a polynomial of degree 512, or jump.
    """
    if not varies:
        fixed = lifted(start)
        return lambda t: fixed

    def at(steps: FloatArray) -> FloatArray:
        """Return the parts at the times of these nodes, the last one first."""
        nodes = 0.5 + 0.5 * np.cos(np.pi * steps)
        return np.array([lifted(start + span * node)[:3] for node in nodes])

    degree, values = _FIRST, at(np.arange(0.5 * _FIRST + 1.0) / (0.5 * _FIRST))
    while degree <= _LAST:
        # The nodes of half the degree are every second one of these.
        between = at(np.arange(1.0, degree, 2.0) / degree)
        values = np.insert(values, np.arange(1, len(values)), between, axis=0)
        c = dct(values, type=1, axis=0) / degree
        c[[0, -1]] *= 0.5
        # The size of w and D A w: D A w, and the flux at the ends, may be round-off of w.
        size = np.abs(c[:, :2]).max(axis=(0, 2, *range(3, c.ndim)), keepdims=True)
        if (np.abs(c[-2:, :2]) <= RESOLVED * np.maximum(size, size[:, :1])).all():
            found = _Interpolated(c, start, span)
            most = _MISSED * float(size.max())
            if all(np.abs(found(t).base - lifted(t).base).max() <= most for t in sudden):
                return found
        degree *= 2
    raise NonFiniteSolution(
        f"the values outside are not resolved by polynomials of degree {_LAST} of the time up to t = {start + span:g}: "
        "they vary too fast or jump. Solve from jump to jump."
    )


class _Interpolated:
    """A lift from Chebyshev coefficients of its parts, shape (degree + 1, 3, ..); w' is the derivative of the first."""

    def __init__(self, c: FloatArray, start: float, span: float) -> None:
        self._shape, self._start, self._span = c.shape[2:], start, span
        self._c = np.zeros((c.shape[0], 4, int(np.prod(self._shape))))
        self._c[:, :3] = c.reshape(*c.shape[:2], -1)
        self._c[:-1, 3] = chebyshev.chebder(self._c[:, 0], scl=2.0 / span)

    def __call__(self, t: float) -> Lift:
        s = min(1.0, max(-1.0, 2.0 * (t - self._start) / self._span - 1.0))
        polynomials = np.cos(np.arccos(s) * np.arange(len(self._c)))
        parts = polynomials @ self._c.reshape(len(self._c), -1)
        return Lift(*parts.reshape(4, *self._shape))
