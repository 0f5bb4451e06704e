r"""Diffusion in its modes, and all other terms beside it, by an exponential integrator: y' = -lambda y + N(y, t).

Krogstad's scheme of order 4 (J. Comput. Phys. 203 (2005) 72) has the coefficients

    phi_k(-z) = int_0^1 e^(-z r) (1 - r)^(k-1) / (k-1)! dr,   k = 1, 2, 3,   z = lambda h.

Stiff rates cost nothing, and without N the steps are exact. Each step is compared with two of half its length; these
two are kept. Where N jumps with u, the three may agree by chance, because N takes few values. So the two slopes in the
middle of the step, N_2 and N_3, must be close as well: h phi_2 (N_2 - N_3) is of third order in h where N is smooth.

Where N jumps in time while u is almost nothing, no step is accurate to a share of u. The shortest step is then taken as
it is: it brings 1e-10 of what N brings in the whole time. In a blow-up N does not change with the time alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.special import factorial

from fracparticles.arguments import FloatArray
from fracparticles.bounded.modes import ModalSteps, size_of
from fracparticles.errors import NonFiniteSolution
from fracparticles.time.steps import ordinary_unit

__all__ = ["ExponentialSteps", "TooManySteps", "moments_of_decay"]

Slope = Callable[[Any, float], Any]
"""N between amplitudes, at a time."""

_FIRST = 1e-3  # the first step over the time span
_SHORTEST = 1e-10  # the shortest step over the time span
_NOTHING = 1e-300  # the least size of u by which an error is divided, in its ordinary unit
# The share of the step that would just meet the tolerance, and the least and the greatest ratio of two steps.
_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 3.0
_ORDER = 3.0  # the order of the difference in the step, where N does not vanish at the edge
_APART = 0.25  # power of the tolerance that the slopes in the middle may be apart: 3/5 is usual in a smooth step
_TERMS = np.arange(24.0)  # k of the series for z <= 1
_FACTORIALS = factorial(_TERMS)


class TooManySteps(NonFiniteSolution):
    """Steps that go on, but not to the end; `time` and `amplitudes` say where they have come to."""

    time: float
    amplitudes: Any


class ExponentialSteps(ModalSteps):
    """Steps of u' = A u + N(t, u), with A in its modes; no eigenvalue limits them, but the rates of N do.

    Attributes
    ----------
    most : int
        The most steps to one time.
    """

    rejected: int = 0
    most: int = 20_000

    def advance(self, u: FloatArray, span: float, start: float = 0.0) -> FloatArray:
        """Return u after the time `span`.

        Raises
        ------
        NonFiniteSolution
            If u becomes infinite, or the steps too short, or too many, `TooManySteps`; says when.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            y = self._modes.into(u)
            unit = ordinary_unit(self._size(start, y))
            return self._modes.back(unit * self._advanced(y / unit, span, start, unit))

    def _advanced(self, y: Any, span: float, start: float, unit: float) -> Any:
        """Return the amplitudes after the time `span`; both are in the unit of `ordinary_unit`."""
        t, h, shortest = 0.0, self._h or _FIRST * span, _SHORTEST * span

        def slope(y: Any, t: float) -> Any:
            return self._slope(unit * y, t) / unit

        for _ in range(self.most):
            h = min(h, span - t)
            step = _Step.of(self._modes.rates, h)
            whole, jump = step.advance(y, start + t, slope)
            half = step.halved()
            middle, _ = half.advance(y, start + t, slope)
            halves, _ = half.advance(middle, start + t + 0.5 * h, slope)
            size = max(self._size(start + t + h, unit * halves) / unit, _NOTHING)
            off = size_of(halves - whole) / size
            if size_of(jump) > self._tolerance**_APART * size:
                off = max(off, self._tolerance / _SHRINK)
            jumps = off > self._tolerance and h <= shortest and _jumps(slope, y, start + t, h)
            if off <= self._tolerance or jumps:
                t, y = t + h, halves
                self.accepted += 1
                if t >= span * (1.0 - 1e-14):
                    self._h = max(h, self._h or 0.0)
                    return y
                self._h = h
            else:
                self.rejected += 1
                if h <= shortest:
                    raise NonFiniteSolution(_stopped(start + t))
            ratio = self._tolerance / off if off > 0.0 else np.inf
            grown = float(np.clip(_SAFETY * ratio ** (1.0 / _ORDER), _SHRINK, _GROW))
            h = max(h * (grown if np.isfinite(off) else _SHRINK), shortest)
        stopped = TooManySteps(_stopped(start + t))
        stopped.time, stopped.amplitudes = start + t, unit * y
        raise stopped

    def _slope(self, y: Any, t: float) -> Any:
        u = self._modes.back(y)
        if not np.isfinite(u).all():
            return np.full(y.shape, np.nan)
        return self._modes.into(self._rest(t, u))


def _stopped(t: float) -> str:
    return (
        f"the solution stops at t = {t:g}: its steps became too short or too many, as they do where it "
        "becomes infinite, or where it is carried much faster than it spreads. End before, or mend the source "
        "or the velocity."
    )


def _jumps(slope: Slope, y: Any, t: float, h: float) -> bool:
    """Whether N changes by a half of itself in a time h, at the same u."""
    before, after = slope(y, t), slope(y, t + h)
    return bool(size_of(after - before) > 0.5 * max(size_of(before), size_of(after)))


class _Decay(NamedTuple):
    """e^-z, and phi_1, phi_2 and phi_3 of -z."""

    factor: FloatArray
    phi1: FloatArray
    phi2: FloatArray
    phi3: FloatArray

    @classmethod
    def of(cls, z: FloatArray) -> _Decay:
        zero, one, two = moments_of_decay(z, 2)
        return cls(np.exp(-z), zero, zero - one, 0.5 * (zero - 2.0 * one + two))


class _Step(NamedTuple):
    """Steps of Krogstad's scheme of one length h, with what decays in h and in h / 2."""

    rates: FloatArray
    h: float
    whole: _Decay
    half: _Decay

    @classmethod
    def of(cls, rates: FloatArray, h: float) -> _Step:
        return cls(rates, h, _Decay.of(h * rates), _Decay.of(0.5 * h * rates))

    def halved(self) -> _Step:
        """Return steps of half the length."""
        return _Step(self.rates, 0.5 * self.h, self.half, _Decay.of(0.25 * self.h * self.rates))

    def advance(self, y: Any, t: float, slope: Slope) -> tuple[Any, Any]:
        """Return y a step later, and h phi_2 (N_2 - N_3)."""
        h, (half_decay, half1, half2, _), (decay, phi1, phi2, phi3) = self.h, self.half, self.whole
        n1 = slope(y, t)
        first = half_decay * y + 0.5 * h * half1 * n1
        n2 = slope(first, t + 0.5 * h)
        n3 = slope(first + h * half2 * (n2 - n1), t + 0.5 * h)
        n4 = slope(decay * y + h * (phi1 * n1 + 2.0 * phi2 * (n3 - n1)), t + h)
        middle = n2 + n3
        change = phi1 * n1 + phi2 * (2.0 * middle - 3.0 * n1 - n4) + 4.0 * phi3 * (n1 - middle + n4)
        return decay * y + h * change, h * phi2 * (n2 - n3)


def moments_of_decay(z: FloatArray, degree: int) -> FloatArray:
    """Return I_m = int_0^1 e^(-z r) r^m dr for m = 0, .., degree, shape (degree + 1, ..).

    For z <= 1 it is sum_k (-z)^k / (k! (m + 1 + k)), beyond I_0 = (1 - e^-z) / z and I_m = (m I_(m-1) - e^-z) / z. The
    recursion loses digits by a factor m! / z^m, so that it is for low degrees.
    """
    large = np.maximum(z, 1.0)
    m = np.arange(degree + 1.0)
    weights = 1.0 / (_FACTORIALS * (m[:, None] + 1.0 + _TERMS))
    powers, small = np.zeros((*z.shape, _TERMS.size)), z <= 1.0
    powers[small] = (-z[small][:, None]) ** _TERMS
    series = powers @ weights.T
    decay, closed = np.exp(-large), [-np.expm1(-large) / large]
    for power in m[1:]:
        closed.append((power * closed[-1] - decay) / large)
    return np.where(small, np.moveaxis(series, -1, 0), closed)
