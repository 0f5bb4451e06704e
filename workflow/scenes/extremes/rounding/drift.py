"""The mass of a closed lattice over very many steps: single, double and compensated, and the library's."""

from __future__ import annotations

from collections.abc import Iterator
from math import fsum, sqrt
from typing import Any

import numpy as np

from fracparticles.run.case import Case
from fracparticles.run.solver import prepare
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.time import STEP_POLYNOMIALS, step
from fracstudy.panels import Panels
from fracstudy.probe import EPS, HELD, Kind, Probe

__all__ = ["probes"]

_SINGLE = float(np.finfo(np.float32).eps)
_FIELDS = {"scheme": "KPSE", "beta": 0.5, "half_width": 5.0, "spacing": 0.5}
_SHARE = 0.5  # of the stability limit


def _case(steps: int, **more: Any) -> Case:
    limit = Case(**_FIELDS, dt=1e-6).largest_stable_step
    dt = _SHARE * limit
    return Case(**_FIELDS, dt=dt, t_final=0.5 + steps * dt, integrator="euler", **more)


def probes(most: int, points: Panels) -> Iterator[Probe]:
    """The sum of the strengths, which the exchange form keeps exactly.

    A step rounds each of N strengths, sums of N terms. If the roundings are independent the mass wanders by eps sqrt(n)
    after n steps; if all have one sign it drifts by n N eps, the bound. The columns of A sum up to zero but for
    eps |A|, which is of the second kind.
    """
    counts = [10**k for k in range(1, round(np.log10(most)) + 1)]
    case = _case(counts[-1])
    operator = SCHEMES["KPSE"].operator(case.setting)
    matrix = np.eye(operator.size) + case.time_step * dense_matrix(operator)
    u0 = np.random.default_rng(9).uniform(0.5, 1.5, operator.size)
    mass, terms = fsum(u0), operator.size

    def drift(u: np.ndarray) -> float:
        return max(abs(fsum(map(float, u)) / mass - 1.0), 0.5 * EPS)

    u, done = u0, 0
    stepped = []
    for n in counts:
        u = step(operator, STEP_POLYNOMIALS["euler"], case.time_step, n - done, u)
        stepped.append(drift(u))
        done = n
    series = [drift(prepare(_case(n)).solve(u0)) for n in counts]
    single = _by_matrix(matrix, u0, counts, np.float32)
    compensated = _compensated(matrix, u0, counts, mass)
    for name, values in (
        ("float64, step by step", stepped),
        ("float64, one series", series),
        ("float32", single),
        ("float64, compensated", compensated),
    ):
        points.add("drift", name, counts, values)
    walk, worst = [sqrt(n) for n in counts], [float(n * terms) for n in counts]
    points.add("drift", "eps sqrt(n)", counts, [EPS * one for one in walk])
    points.add("drift", "eps n N", counts, [EPS * one for one in worst])

    row = Kind("mass", "kept; drift below n N eps", must=HELD)
    for name, values, eps in (
        ("step by step", stepped, EPS),
        ("one series", series, EPS),
        ("float32, for comparison", single, _SINGLE),
        ("compensated, for comparison", compensated, EPS),
    ):
        for n, value in zip(
            counts[1::2] if len(counts) > 3 else counts,
            values[1::2] if len(counts) > 3 else values,
            strict=True,
        ):
            yield row(
                f"KPSE, {n:.0e} steps of Euler, {name}",
                float,
                value,
                bound=n * terms * eps,
                source="math.fsum",
            )
    both = float(np.abs(prepare(_case(most)).solve(u0) / u - 1.0).max())
    yield row(
        f"KPSE, {most:.0e} steps, step by step and one series",
        float,
        both,
        expected="the same, below n N eps",
        bound=most * terms * EPS,
    )


def _by_matrix(matrix: np.ndarray, u0: np.ndarray, counts: list[int], kind: type) -> list[float]:
    """The drift where all numbers are of a kind."""
    a: Any = matrix.astype(kind)
    u: Any = u0.astype(kind)
    start, done, found = fsum(map(float, u)), 0, []
    for n in counts:
        for _ in range(n - done):
            u = a @ u
        done = n
        found.append(max(abs(fsum(map(float, u)) / start - 1.0), 0.5 * EPS))
    return found


def _compensated(matrix: np.ndarray, u0: np.ndarray, counts: list[int], mass: float) -> list[float]:
    """The drift where what one step rounds off is added in the next (Kahan)."""
    change = matrix - np.eye(len(matrix))
    change -= np.diag(change.sum(axis=0))  # columns that sum up to zero, to the last bit but one
    u, lost, done, found = u0.copy(), np.zeros_like(u0), 0, []
    for n in counts:
        for _ in range(n - done):
            added = change @ u + lost
            total = u + added
            lost = added - (total - u)
            u = total
        done = n
        found.append(max(abs(fsum([*u, *lost]) / mass - 1.0), 0.5 * EPS))
    return found
