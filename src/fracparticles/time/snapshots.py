"""Several output times of one run: one Chebyshev recurrence serves them all.

f_j(A) u = sum_k c_jk T_k(B) u. The output times differ only in the coefficients, and the vectors T_k(B) u of the last
and longest series serve all. For a run in steps the f_j are products of step polynomials, since the steps end at each
output time: f_j = p(A dt_1)^{n_1} .. p(A dt_j)^{n_j}.

Where one series would lose digits the outputs are divided in two halves. Each half has its own recurrence, which
starts from the last output before it. A single output is computed like any run, see `pieces`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from fracparticles.errors import NonFiniteSolution
from fracparticles.lattice.operators import Operator
from fracparticles.time.chebyshev import (
    LARGEST_EXPONENT,
    ChebyshevSeries,
    LostDigits,
    evaluate,
    exponential,
    power,
)
from fracparticles.time.pieces import Flow, exponential_flow, power_flow
from fracparticles.time.polynomial import StepPolynomial
from fracparticles.time.stepping import step

__all__ = ["Legs", "Snapshots", "exponential_snapshots", "march", "power_snapshots"]

Legs = Sequence[tuple[float, int]]
"""The time step and the number of steps from each output time to the next."""

_SAME = 1e-12  # relative difference of two time steps: less is round-off


class Snapshots:
    """f_1(A), .. f_m(A), the run up to each of m output times.

    Parameters
    ----------
    operator : Operator
        A.
    count : int
        m.
    series_of : callable
        From i and j to the series that leads from output i to output j; output 0 is the start.
    flow_of : callable
        From j to the flow that leads from output j - 1 to output j.
    largest_degree : int, optional
        See `pieces.Flow`.

    Attributes
    ----------
    operator_applications : int
        How often A is applied, unless digits are lost on the way.
    """

    def __init__(
        self,
        operator: Operator,
        count: int,
        series_of: Callable[[int, int], ChebyshevSeries],
        flow_of: Callable[[int], Flow],
        largest_degree: int | None = None,
    ) -> None:
        self.operator = operator
        self._series_of = lru_cache(maxsize=4 * count)(series_of)
        self._flow_of = lru_cache(maxsize=count)(flow_of)
        self._most = largest_degree
        self._parts = self._cut(0, count)
        self.operator_applications = sum(self._applications(*part) for part in self._parts)

    def _cut(self, start: int, stop: int) -> list[tuple[int, int]]:
        """Halve the outputs until each part is one series that is short enough, or a single output."""
        if stop - start == 1 or self._most is None or self._degree(start, stop) <= self._most:
            return [(start, stop)]
        middle = (start + stop) // 2
        return self._cut(start, middle) + self._cut(middle, stop)

    def _degree(self, start: int, stop: int) -> int:
        return self._series_of(start, stop).degree

    def _applications(self, start: int, stop: int) -> int:
        if stop - start == 1:
            return self._flow_of(stop).operator_applications
        return max(self._degree(start, j) for j in range(start + 1, stop + 1))

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return the strengths at each output time, shape (m, N); raises as `run`."""
        return self.run(u)[0]

    def run(self, u: np.ndarray) -> tuple[np.ndarray, int]:
        """Return the strengths at each output time, shape (m, N), and how often A was applied.

        Raises
        ------
        NonFiniteSolution
            If a particle strength is not finite.
        FracparticlesError
            If the digits cannot be kept within 3e7 applications.
        """
        outputs, applications = [u[None]], 0
        for part in self._parts:
            reached, count = self._between(outputs[-1][-1], *part)
            outputs.append(reached)
            applications += count
        return np.concatenate(outputs[1:]), applications

    def _between(self, u: np.ndarray, start: int, stop: int) -> tuple[np.ndarray, int]:
        if stop - start == 1:
            single, applications = self._flow_of(stop).run(u)
            return single[None], applications
        series = [self._series_of(start, j) for j in range(start + 1, stop + 1)]
        try:
            return evaluate(series, self.operator, u), max(one.degree for one in series)
        except LostDigits:
            middle, thrown_away = (start + stop) // 2, max(one.degree for one in series)
        first, count = self._between(u, start, middle)
        second, more = self._between(first[-1], middle, stop)
        return np.concatenate([first, second]), thrown_away + count + more


def exponential_snapshots(
    operator: Operator,
    spans: Sequence[float],
    low: float,
    high: float,
    largest_degree: int | None = None,
) -> Snapshots:
    """Return exp(A t) for each t of `spans`, the ascending times since the start; the spectrum is in [low, high]."""
    at = (0.0, *spans)
    return Snapshots(
        operator,
        len(spans),
        lambda i, j: exponential(at[j] - at[i], low, high),
        lambda j: exponential_flow(operator, at[j] - at[j - 1], low, high, largest_degree),
        largest_degree,
    )


def power_snapshots(
    operator: Operator,
    polynomial: StepPolynomial,
    legs: Legs,
    low: float,
    high: float,
    largest_degree: int | None = None,
) -> Snapshots:
    """Return p(A dt_1)^{n_1} .. p(A dt_j)^{n_j} for each leg j.

    A leg is a time step dt_j and the number n_j of its steps. The spectrum of A lies in [low, high].
    """
    return Snapshots(
        operator,
        len(legs),
        lambda i, j: _powers(polynomial, legs[i:j], low, high),
        lambda j: power_flow(operator, polynomial, *legs[j - 1], low, high, largest_degree),
        largest_degree,
    )


def march(operator: Operator, polynomial: StepPolynomial, legs: Legs, u: np.ndarray) -> np.ndarray:
    """Step from one output time to the next; return the strengths at each, shape (legs, N).

    Raises
    ------
    NonFiniteSolution
        As `stepping.step`.
    """
    outputs = []
    for dt, steps in legs:
        u = step(operator, polynomial, dt, steps, u)
        outputs.append(u)
    return np.array(outputs)


def _powers(polynomial: StepPolynomial, legs: Legs, low: float, high: float) -> ChebyshevSeries:
    """Return the series of the product of p(z dt)^n over some legs."""
    legs = _merged(legs)
    if len(legs) == 1:
        return power(polynomial, *legs[0], low, high)

    def amplification(z: np.ndarray) -> np.ndarray:
        parts = [polynomial.log_power(z * dt, steps) for dt, steps in legs]
        exponent = np.sum([part for _, part in parts], axis=0)
        if exponent.max() > LARGEST_EXPONENT:
            largest = max(dt for dt, _ in legs)
            raise NonFiniteSolution(
                f"{polynomial.name} with steps of up to {largest:.6g} overflows: they are outside the stability "
                f"interval (limit {polynomial.stability_interval / -low:.6g}). "
                "Take a smaller dt or integrator='exponential'."
            )
        return np.asarray(np.prod([sign for sign, _ in parts], axis=0) * np.exp(exponent))

    def condition(z: np.ndarray) -> np.ndarray:
        parts = [
            np.abs(polynomial.log_power(z * dt, steps)[1]) + polynomial.sensitivity(z * dt, steps)
            for dt, steps in legs
        ]
        return np.asarray(1.0 + np.sum(parts, axis=0))

    series = ChebyshevSeries.of(amplification, low, high, condition)
    degree = polynomial.stages * sum(steps for _, steps in legs)
    return replace(series, coefficients=series.coefficients[: degree + 1])


def _merged(legs: Legs) -> list[tuple[float, int]]:
    """The legs, with all steps of one length counted together."""
    merged: list[tuple[float, int]] = []
    for dt, steps in legs:
        same = [k for k, (other, _) in enumerate(merged) if abs(other - dt) <= _SAME * dt]
        if same:
            merged[same[0]] = (merged[same[0]][0], merged[same[0]][1] + steps)
        else:
            merged.append((dt, steps))
    return merged
