"""The mass of a closed lattice over very many steps: single, double and compensated, and the library's."""

from collections.abc import Iterable, Iterator
from math import fsum, sqrt
from typing import Any

import numpy as np

from fracparticles.run.case import Case
from fracparticles.run.solver import prepare
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.time import STEP_POLYNOMIALS, step
from fracstudy.panels import Panels
from fracstudy.probe import EPS, HELD, Kind, Probe, off

_SINGLE = float(np.finfo(np.float32).eps)
_FIELDS = {"scheme": "KPSE", "beta": 0.5, "half_width": 5.0, "spacing": 0.5}
_SHARE = 0.5  # of the stability limit


def _case(steps: int, **more: Any) -> Case:
    limit = Case(**_FIELDS, dt=1e-6).largest_stable_step
    dt = _SHARE * limit
    return Case(**_FIELDS, dt=dt, t_final=0.5 + steps * dt, integrator="euler", **more)


def probes(steps: int, points: Panels) -> Iterator[Probe]:
    """The sum of the strengths, which the exchange form keeps exactly.

    A step rounds each of N strengths, sums of N terms. If the roundings are independent the mass wanders by eps sqrt(n)
    after n steps; if all have one sign it drifts by n N eps, the bound. The columns of A sum up to zero but for
    eps |A|, which is of the second kind.
    """
    counts = [10**k for k in range(1, round(np.log10(steps)) + 1)]
    case = _case(counts[-1])
    operator = SCHEMES["KPSE"].operator(case.setting)
    matrix = np.eye(operator.size) + case.time_step * dense_matrix(operator)
    u0 = np.random.default_rng(9).uniform(0.5, 1.5, operator.size)
    mass, terms = fsum(u0), operator.size

    u, stepped = u0, []
    for n in np.diff(counts, prepend=0).tolist():
        u = step(operator, STEP_POLYNOMIALS["euler"], case.time_step, n, u)
        stepped.append(_drift(u, mass))
    series = [_drift(prepare(_case(n)).solve(u0), mass) for n in counts]
    single = _by_matrix(matrix, u0, counts, np.float32)
    compensated = _compensated(matrix, u0, counts, mass)
    ways = (
        ("float64, step by step", "step by step", stepped, EPS),
        ("float64, one series", "one series", series, EPS),
        ("float32", "float32, for comparison", single, _SINGLE),
        ("float64, compensated", "compensated, for comparison", compensated, EPS),
    )
    for name, _, values, _ in ways:
        points.add("drift", name, counts, values)
    points.add("drift", "eps sqrt(n)", counts, [EPS * sqrt(n) for n in counts])
    points.add("drift", "eps n N", counts, [EPS * float(n * terms) for n in counts])

    kept = Kind("mass", "kept; drift below n N eps", source="math.fsum", must=HELD)
    shown = slice(1, None, 2) if len(counts) > 3 else slice(None)
    for _, name, values, eps in ways:
        for n, value in zip(counts[shown], values[shown], strict=True):
            words = f"KPSE, {n:.0e} steps of Euler, {name}"
            yield kept(words, float, value, bound=n * terms * eps)
    same = Kind("mass", "the same, below n N eps", steps * terms * EPS, must=HELD)
    yield same(
        f"KPSE, {steps:.0e} steps, step by step and one series",
        lambda: off(prepare(_case(steps)).solve(u0) / u, 1.0),
    )


def _drift(u: Iterable[float], mass: float) -> float:
    """How far the sum of the strengths is from that at the start; half an ulp, if it is not."""
    return max(abs(fsum(map(float, u)) / mass - 1.0), 0.5 * EPS)


def _by_matrix(matrix: np.ndarray, u0: np.ndarray, counts: list[int], kind: type) -> list[float]:
    """The drift where all numbers are of a kind."""
    a: Any = matrix.astype(kind)
    u: Any = u0.astype(kind)
    start, found = fsum(map(float, u)), []
    for n in np.diff(counts, prepend=0):
        for _ in range(n):
            u = a @ u
        found.append(_drift(u, start))
    return found


def _compensated(matrix: np.ndarray, u0: np.ndarray, counts: list[int], mass: float) -> list[float]:
    """The drift where what one step rounds off is added in the next (Kahan)."""
    change = matrix - np.eye(len(matrix))
    change -= np.diag(change.sum(axis=0))  # columns that sum up to zero, to the last bit but one
    u, lost, found = u0.copy(), np.zeros_like(u0), []
    for n in np.diff(counts, prepend=0):
        for _ in range(n):
            added = change @ u + lost
            total = u + added
            u, lost = total, added - (total - u)
        found.append(_drift([*u, *lost], mass))
    return found
