"""Functions of an operator by one Chebyshev series: the whole time integration in a few hundred products.

If the spectrum of A lies in [low, high] (or close to it),

    f(A) u = sum_k c_k T_k(B) u,   B = (2 A - high - low) / (high - low),

where c_k are the Chebyshev coefficients of f on the interval and T_k(B) u follows from the three-term
recurrence T_{k+1} = 2 B T_k - T_{k-1}. For f = p(A dt)^n, n steps of a Runge-Kutta scheme, the sum is the same
discrete solution as stepping gives, up to round-off; but p^n is so smooth on the interval that its
coefficients fall below round-off after about sqrt(74 T |low| / 2) terms, whatever the number of steps.
Tal-Ezer & Kosloff, J. Chem. Phys. 81 (1984) 3967, for the exponential.

The terms may be far larger than their sum. This happens where the operator is not normal or has eigenvalues that are
not real, so that T_k(B) u grows with k, and where the solution decays by many decades. The evaluation checks the size
of its terms and
raises `LostDigits`; `pieces` then continues with shorter series.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.fft import dct

from fracparticles._compiled import njit
from fracparticles.errors import FracparticlesError, NonFiniteSolution
from fracparticles.lattice.operators import Operator
from fracparticles.time.polynomial import StepPolynomial
from fracparticles.time.stepping import all_finite

__all__ = ["ChebyshevSeries", "LostDigits", "evaluate", "exponential", "power"]

_ROUND_OFF = 2.0**-54  # of a value or coefficient, relative
_MET = 1e-6  # share of the largest value of f: how close the series must be to f at the ends
_MOST_POINTS = 2**25  # of an interpolation: a quarter of a gigabyte for each array
LARGEST_EXPONENT = np.log(np.finfo(float).max)  # of exp in float64

_LOOK_EVERY = 32  # terms between two looks at their size
_DIGITS_KEPT = 1e-10  # the share of the sum that the round-off of its terms may reach
_SHORT = 64  # so few terms cannot cancel by much: a piece of this degree is taken as it is


class LostDigits(FracparticlesError):
    """The terms of a series are so much larger than their sum that their round-off spoils it."""


@dataclass(frozen=True)
class ChebyshevSeries:
    """f(z) = sum_k c_k T_k((2 z - high - low) / (high - low)).

    Attributes
    ----------
    coefficients : array, shape (degree + 1,)
        c_k; those at the end that are negligible beside the largest are dropped.
    low, high : float
        The interval.
    """

    coefficients: np.ndarray
    low: float
    high: float

    @classmethod
    def of(
        cls,
        f: Callable[[np.ndarray], np.ndarray],
        low: float,
        high: float,
        condition: Callable[[np.ndarray], np.ndarray] = np.ones_like,
        expected: float = 0.0,
    ) -> ChebyshevSeries:
        """Interpolate f at Chebyshev points.

        The points are enough if two things hold. The last third of the coefficients is below the round-off in the
        values of f, which is `condition(z)` ulp of f(z). And the sum meets f at the two ends, since a layer there that
        is thinner than the distance of the points would be missed.

        Raises
        ------
        FracparticlesError
            If it takes more than 2^25 points.
        """
        ends = np.array([low, high])
        at_ends = f(ends)
        points = 1 << max(5, int(expected).bit_length() - 1)
        while points <= _MOST_POINTS:
            angle = (np.arange(points) + 0.5) * (np.pi / points)
            # (1 + cos) / 2 = cos^2(angle / 2): the distance to `high` keeps its relative accuracy.
            z = high - (high - low) * np.sin(0.5 * angle) ** 2
            values = f(z)
            coefficients = dct(values, type=2) / points
            coefficients[0] /= 2.0
            largest = max(np.abs(values).max(), np.abs(at_ends).max())
            noise = _ROUND_OFF * max(
                (np.abs(values) * condition(z)).max(), (np.abs(at_ends) * condition(ends)).max()
            )
            significant = np.flatnonzero(np.abs(coefficients) > noise)
            degree = significant[-1] if significant.size else 0
            met = np.abs(cls(coefficients, low, high).at_ends - at_ends) <= _MET * largest
            if met.all() and degree < 2 * points // 3:
                return cls(coefficients[: degree + 1], low, high)
            points *= 2
        raise FracparticlesError(
            f"the time integration from the spectrum in [{low:.3g}, {high:.3g}] takes a Chebyshev series of more than "
            f"{_MOST_POINTS} terms"
        )

    @property
    def degree(self) -> int:
        """The number of operator applications that an evaluation takes."""
        return self.coefficients.size - 1

    @property
    def at_ends(self) -> tuple[float, float]:
        """f at the ends of the interval."""
        even, odd = self.coefficients[::2].sum(), self.coefficients[1::2].sum()
        return float(even - odd), float(even + odd)

    def __call__(self, operator: Operator, u: np.ndarray) -> np.ndarray:
        """Return f(A) u, shape (N,).

        Raises
        ------
        LostDigits
            If the round-off of the terms is more than 1e-10 of the sum, in the maximum norm, or they overflow.
        NonFiniteSolution
            If a sum of no more than 65 terms is not finite.
        """
        return evaluate((self,), operator, u)[0]


def evaluate(series: Sequence[ChebyshevSeries], operator: Operator, u: np.ndarray) -> np.ndarray:
    """Return f_j(A) u of several series on one interval by one recurrence, shape (series, N).

    The vectors T_k(B) u are the same for all, so this takes no more applications than the longest series alone.

    Raises
    ------
    LostDigits
        If the round-off of the terms of one is more than 1e-10 of its sum, in the maximum norm, or they overflow.
    NonFiniteSolution
        If a sum of no more than 65 terms is not finite.
    """
    degree, low, high = max(one.degree for one in series), series[0].low, series[0].high
    c = np.zeros((len(series), degree + 2))
    for row, one in zip(c, series, strict=True):
        row[: one.degree + 1] = one.coefficients
    scale, shift = 2.0 / (high - low), -(high + low) / (high - low)
    even, odd = np.array(u, dtype=float), np.zeros(np.shape(u))  # T_k(B) u, k even and odd
    if degree == 0:
        return c[:, :1] * even
    largest = np.abs(c[:, 0]) * _size(even)
    operator.combine(even, odd, scale, shift)
    totals = np.zeros((len(series), even.size))
    _add_terms(totals, c, 0, even, odd)
    for k in range(2, degree, 2):
        operator.combine(odd, even, 2.0 * scale, 2.0 * shift, -1.0)
        operator.combine(even, odd, 2.0 * scale, 2.0 * shift, -1.0)
        _add_terms(totals, c, k, even, odd)
        if k % _LOOK_EVERY == 0:
            largest = np.maximum(largest, np.abs(c[:, k]) * _size(even))
    if degree % 2 == 0:
        operator.combine(odd, even, 2.0 * scale, 2.0 * shift, -1.0)
        _add_terms(totals, c, degree, even, odd)
    for one, size, total in zip(series, largest, totals, strict=True):
        _look_at(one.degree, float(size), total)
    return totals


def _look_at(degree: int, largest: float, total: np.ndarray) -> None:
    if degree <= _SHORT:
        if not all_finite(total):
            raise NonFiniteSolution(
                "the particle strengths overflow: the time step lies far outside the stability interval. "
                "Take a smaller dt or integrator='exponential'."
            )
        return
    size = _size(total) if all_finite(total) else np.inf
    lost = _ROUND_OFF * np.sqrt(degree) * largest
    if not lost <= _DIGITS_KEPT * size < np.inf:
        raise LostDigits(f"terms of {largest:.3g} in a Chebyshev series whose sum is {size:.3g}")


def power(
    polynomial: StepPolynomial, dt: float, steps: int, low: float, high: float
) -> ChebyshevSeries:
    """Return the series of p(z dt)^steps on [low, high].

    Raises
    ------
    NonFiniteSolution
        If p(z dt)^steps overflows on the interval: then stepping overflows too, at the step named.
    """

    def amplification(z: np.ndarray) -> np.ndarray:
        sign, exponent = polynomial.log_power(z * dt, steps)
        growth = exponent.max() / steps
        if growth * steps > LARGEST_EXPONENT:
            overflow = int(np.ceil(LARGEST_EXPONENT / growth))
            raise NonFiniteSolution(
                f"{polynomial.name} with dt = {dt:.6g} amplifies the shortest wave by {np.exp(growth):.6g} a "
                f"step and overflows near step {overflow} of {steps}, {overflow * dt:.6g} after the start: "
                f"dt is outside the stability interval (limit {polynomial.stability_interval / -low:.6g}). "
                "Take a smaller dt or integrator='exponential'."
            )
        return sign * np.exp(exponent)

    def condition(z: np.ndarray) -> np.ndarray:
        _, exponent = polynomial.log_power(z * dt, steps)
        return 1.0 + np.abs(exponent) + polynomial.sensitivity(z * dt, steps)

    expected = min(steps * polynomial.stages, _expected_degree(steps * dt, low, high))
    series = ChebyshevSeries.of(amplification, low, high, condition, expected)
    # p^steps is a polynomial of degree `steps * stages`: later coefficients are round-off.
    return replace(series, coefficients=series.coefficients[: steps * polynomial.stages + 1])


def exponential(time: float, low: float, high: float) -> ChebyshevSeries:
    """Return the series of exp(z time) on [low, high]: exact in time.

    Raises
    ------
    NonFiniteSolution
        If exp(z time) overflows on the interval.
    """
    growth = high * time
    if growth > LARGEST_EXPONENT:
        raise NonFiniteSolution(
            f"the operator has the eigenvalue {high:.6g} and amplifies its mode by exp({growth:.6g}) over the "
            f"time {time:.6g}: the particle strengths overflow. Take a larger overlap, or a shorter time."
        )
    return ChebyshevSeries.of(
        lambda z: np.exp(z * time),
        low,
        high,
        lambda z: 1.0 + np.abs(z * time),
        _expected_degree(time, low, high),
    )


def _expected_degree(time: float, low: float, high: float) -> float:
    """The coefficients of exp(z time) fall like exp(-k^2 / (time (high - low))), to 2^-54 of the condition."""
    return float(np.sqrt(25.0 * time * (high - low)))


def _size(u: np.ndarray) -> float:
    return float(max(u.max(), -u.min()))


@njit()
def _add_terms(totals, c, k, even, odd):
    # Two at a time: half the traffic of the sums.
    for j in range(totals.shape[0]):
        a, b = c[j, k], c[j, k + 1]
        if a != 0.0 or b != 0.0:  # else that series has ended
            total = totals[j]
            for i in range(total.size):
                total[i] += a * even[i] + b * odd[i]
