r"""Reactions on an interval: u_t = D A u + f(x, t, u), in the modes of A, by an exponential integrator.

With u = w + V^(-1/2) Q y, w what values outside alone would hold in place and lambda the rates of the modes Q,

    y' = -lambda y + N(y, t),   N = Q^T V^(1/2) f(x, t, u),

is solved by Krogstad's scheme of order 4 (J. Comput. Phys. 203 (2005) 72), whose coefficients are, with z = lambda h,

    phi_k(-z) = int_0^1 e^(-z r) (1 - r)^(k-1) / (k-1)! dr,   k = 1, 2, 3:

stiff rates cost nothing. Each step is compared with two of half its length, which are kept.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.interval_time import moments_of_decay
from fracparticles.errors import NonFiniteSolution

__all__ = ["react"]

_Rate = Callable[[FloatArray, float], FloatArray]

_FIRST = 1e-3  # of the time: the first step
_SHORTEST = 1e-10
_MOST = 20_000  # steps
_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 3.0
_ORDER = 3.0  # of the difference, where f does not vanish at the ends


def react(
    line: Interval,
    initial: Any,
    time: float,
    source: Callable[[FloatArray, float, FloatArray], FloatArray],
    outside: Any = None,
    tolerance: float = 1e-8,
) -> FloatArray:
    """Return u at the particles of an interval, shape (N,), a time after `initial`.

    Parameters
    ----------
    line : Interval
    initial : callable, array or number
        u(x, 0), or its values at the particles.
    time : float
    source : callable
        f(x, t, u), by arrays x and u.
    outside : callable or number, optional
        g(y), where the exterior is given.
    tolerance : float
        Of each step, relative to u.

    Raises
    ------
    InvalidInput
        If an argument is not what it may be.
    NonFiniteSolution
        If u becomes infinite, or the steps too short or too many; says when.
    """
    line = check.instance("line", line, Interval)
    time = check.positive_real("time", time)
    tolerance = check.real_between("tolerance", tolerance, 1e-12, 1e-2)
    check.function("source", source)
    held = line.held(outside)
    start = line.starting(initial)
    rates, vectors = line.all_modes()
    root = np.sqrt(line.volumes)

    def reaction(y: FloatArray, t: float) -> FloatArray:
        u = held + vectors @ y / root
        if not np.isfinite(u).all():
            return np.full(y.size, np.nan)
        with np.errstate(over="ignore", invalid="ignore"):
            f = np.asarray(source(line.x, t, u), dtype=float)
        return np.asarray(vectors.T @ (root * np.broadcast_to(f, u.shape)))

    check.sampled("source", lambda x: source(x, 0.0, start) + 0.0 * x, line.x)
    y = _steps(rates, vectors.T @ (root * (start - held)), reaction, time, tolerance)
    return np.asarray(held + vectors @ y / root)


def _steps(
    rates: FloatArray, y: FloatArray, reaction: _Rate, time: float, tolerance: float
) -> FloatArray:
    t, h = 0.0, _FIRST * time
    for _ in range(_MOST):
        h = min(h, time - t)
        with np.errstate(over="ignore", invalid="ignore"):
            whole = _Step(rates, h).advance(y, t, reaction)
            half = _Step(rates, 0.5 * h)
            halves = half.advance(half.advance(y, t, reaction), t + 0.5 * h, reaction)
            off = float(np.linalg.norm(halves - whole)) / max(float(np.linalg.norm(halves)), 1e-300)
        if off <= tolerance:
            t, y = t + h, halves
            if t >= time * (1.0 - 1e-14):
                return y
        ratio = tolerance / off if off > 0.0 else np.inf
        good = np.isfinite(off)
        h *= float(np.clip(_SAFETY * ratio ** (1.0 / _ORDER), _SHRINK, _GROW)) if good else _SHRINK
        if h < _SHORTEST * time:
            break
    raise NonFiniteSolution(
        f"the solution stops at t = {t:g}: its steps became too short or too many, as they do where it becomes "
        "infinite. End before, or mend the source."
    )


class _Step:
    """One step of Krogstad's scheme, of one length."""

    def __init__(self, rates: FloatArray, h: float) -> None:
        self._h = h
        self._half_decay, self._decay = np.exp(-0.5 * h * rates), np.exp(-h * rates)
        self._half = _phi(0.5 * h * rates)
        self._whole = _phi(h * rates)

    def advance(self, y: FloatArray, t: float, reaction: _Rate) -> FloatArray:
        """Return y a step later."""
        h, (half1, half2, _), (phi1, phi2, phi3) = self._h, self._half, self._whole
        n1 = reaction(y, t)
        first = self._half_decay * y + 0.5 * h * half1 * n1
        n2 = reaction(first, t + 0.5 * h)
        n3 = reaction(first + h * half2 * (n2 - n1), t + 0.5 * h)
        n4 = reaction(self._decay * y + h * (phi1 * n1 + 2.0 * phi2 * (n3 - n1)), t + h)
        middle = n2 + n3
        change = phi1 * n1 + phi2 * (2.0 * middle - 3.0 * n1 - n4) + 4.0 * phi3 * (n1 - middle + n4)
        return np.asarray(self._decay * y + h * change)


def _phi(z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """phi_1, phi_2 and phi_3 of -z."""
    zero, one, two = moments_of_decay(z, 2)
    return zero, zero - one, 0.5 * (zero - 2.0 * one + two)
