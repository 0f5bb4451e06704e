"""A function of an operator over a whole span, in as few pieces as keep their digits.

f(A)^n = f(A)^{n_1} f(A)^{n_2} ...: a span of n units is computed by one Chebyshev series, or by several in a row. One
series takes about sqrt(n) applications of A, and m pieces take sqrt(m) times as many. Pieces are therefore used only
where one series loses digits (`chebyshev.LostDigits`): where its terms are far larger than their sum, because A is
not normal or the solution decays by many decades. Each piece is exact to the round-off of its own terms. Between the
pieces the strengths are scaled by powers of two, so that a decaying solution keeps its digits to the end; strengths
that finally underflow are zero.

The unit is a step of a Runge-Kutta scheme; for the exponential, a 2^-30th of the time.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NoReturn

import numpy as np

from fracparticles.errors import FracparticlesError, NonFiniteSolution
from fracparticles.lattice.operators import Operator
from fracparticles.time.chebyshev import ChebyshevSeries, LostDigits, exponential, power
from fracparticles.time.polynomial import StepPolynomial
from fracparticles.time.stepping import all_finite

__all__ = ["Flow", "exponential_flow", "power_flow"]

_UNITS = 2**30  # of the exponential: a power of two, so that every piece has an exact length
_MOST_APPLICATIONS = 3e7  # of A in a run: ten minutes for a hundred particles
_GONE = -1100  # binary exponent of zero: 2^-1100 underflows, even times 2^26, by which a non-normal A may amplify
_OVERFLOW = 1024  # binary exponent of the first number above float64
_NO_GROWTH = 1e-12  # |f| - 1 of a piece at the ends of the interval: less is round-off


class Flow:
    """f(A) over a span of so many units.

    Parameters
    ----------
    operator : Operator
        A.
    series_of : callable
        From a number of units to the Chebyshev series of f over them.
    units : int
        The span.
    largest_degree : int, optional
        The largest degree of a piece, for an operator whose spectrum is not proved to lie where the series assumes it.

    Attributes
    ----------
    operator_applications : int
        How often A is applied, unless pieces have to be divided further.

    Raises
    ------
    FracparticlesError
        If the run would take more than 3e7 applications.
    """

    def __init__(
        self,
        operator: Operator,
        series_of: Callable[[int], ChebyshevSeries],
        units: int,
        largest_degree: int | None = None,
    ) -> None:
        self.operator, self._units = operator, units
        self._series = lru_cache(maxsize=4)(series_of)
        self._piece = units
        degree = self._series(self._piece).degree
        while largest_degree is not None and self._piece > 1 and degree > largest_degree:
            # The degree grows like the root of the piece, so that so many halvings are needed for certain.
            for _ in range(max(1, int(2.0 * np.log2(degree / largest_degree)) - 1)):
                self._piece = -(-self._piece // 2)
            degree = self._series(self._piece).degree
        whole, rest = divmod(units, self._piece)
        self.operator_applications = whole * degree + (self._series(rest).degree if rest else 0)
        if self.operator_applications > _MOST_APPLICATIONS:
            raise FracparticlesError(
                f"the time integration takes {self.operator_applications:.2g} applications of the operator, in pieces "
                f"of {degree}, and {_MOST_APPLICATIONS:.0e} at most are done"
            )

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return f(A) u, shape (N,).

        Raises
        ------
        NonFiniteSolution
            If a particle strength is not finite.
        """
        return self.run(u)[0]

    def run(self, u: np.ndarray) -> tuple[np.ndarray, int]:
        """Return f(A) u and how often A was applied, including work that was discarded.

        Raises
        ------
        NonFiniteSolution
            If a particle strength is not finite.
        FracparticlesError
            If the digits cannot be kept within 3e7 applications.
        """
        left, piece, applications, exponent = self._units, self._piece, 0, 0
        while left:
            u, exponent = _near_one(u, exponent)
            if exponent > _OVERFLOW:
                self._overflow(left)
            series = self._series(min(piece, left))
            if exponent < _GONE and max(map(abs, series.at_ends)) <= 1.0 + _NO_GROWTH:
                return np.zeros_like(u), applications
            applications += series.degree
            try:
                u = series(self.operator, u)
            except LostDigits as error:
                piece = -(-min(piece, left) // 2)
                if piece == 1 or applications > _MOST_APPLICATIONS:
                    raise FracparticlesError(
                        f"the time integration loses its digits ({error}) and would take more than "
                        f"{_MOST_APPLICATIONS:.0e} applications of the operator in shorter pieces. Take a larger "
                        "spacing or a shorter time span."
                    ) from None
            else:
                left -= min(piece, left)
        with np.errstate(over="ignore"):  # an overflow raises below
            u = np.ldexp(u, exponent)
        if not all_finite(u):
            self._overflow(left)
        return u, applications

    def _overflow(self, left: int) -> NoReturn:
        raise NonFiniteSolution(
            f"the particle strengths overflow after {1.0 - left / self._units:.3g} of the time of the run. Take a "
            "shorter run; a smaller dt, or integrator='exponential', where the steps are unstable; a larger overlap, "
            "where the scheme is."
        )


def _near_one(u: np.ndarray, exponent: int) -> tuple[np.ndarray, int]:
    """Return the product u 2^exponent with the largest |u| near one; only underflow changes any bits of u."""
    more = int(np.frexp(np.abs(u).max(initial=0.0))[1])
    return (np.ldexp(u, -more), exponent + more) if more else (u, exponent)


def exponential_flow(
    operator: Operator,
    time: float,
    low: float,
    high: float,
    largest_degree: int | None = None,
) -> Flow:
    """Return the flow u -> exp(A time) u of an operator A whose spectrum lies in [low, high]."""
    unit = time / _UNITS  # exact
    return Flow(operator, lambda n: exponential(n * unit, low, high), _UNITS, largest_degree)


def power_flow(
    operator: Operator,
    polynomial: StepPolynomial,
    dt: float,
    steps: int,
    low: float,
    high: float,
    largest_degree: int | None = None,
) -> Flow:
    """Return the flow u -> p(A dt)^steps u of an operator A whose spectrum lies in [low, high]."""
    return Flow(operator, lambda n: power(polynomial, dt, n, low, high), steps, largest_degree)
