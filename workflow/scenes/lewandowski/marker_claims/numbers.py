"""The number of markers per eps, and what else the error depends on (M-C2)."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import MarkerVelocity, shape_function
from fracstudy.findings import Finding, measured
from scenes.lewandowski.marker_claims.error_law import lattice_error
from scenes.lewandowski.square_profile import LOADINGS, SQUARE, SquareRuns, load

_ENOUGH = (10.0, 16.0)  # markers per eps: 10-15
_TIMES_MORE = 4  # how many times as many markers are compared


def rows(
    square: SquareRuns, shape: str, loading: str, seed: int, counts: list[int]
) -> Iterator[dict[str, Any]]:
    """E at the end, by number of markers."""
    for count in counts:
        trace = square.having(markers=count).trace(shape, loading, seed, follow=False)
        if trace.run:
            n = count * square.support / np.ptp(trace.end.x)
            row = {"what": "E", "S": shape, "loading": LOADINGS[loading], "x": n, "N": count}
            yield {**row, "at": f"{n:.1f} markers per ε", "ours": trace.error[-1]}


def findings(numbers: pd.DataFrame, square: SquareRuns, seeds: range) -> Iterator[Finding]:
    """What is enough, what more gives, and what else matters."""
    yield _enough(numbers, square)
    yield _more(numbers, square, seeds)
    yield _per_support()
    yield from _parameters(square, seeds[0])


def _norm(square: SquareRuns) -> float:
    """The norm of f on the fixed grid, as E is a norm."""
    return float(np.sqrt((square.z[1] - square.z[0]) * np.sum(square.exact**2)))


def _enough(numbers: pd.DataFrame, square: SquareRuns) -> Finding:
    error, beyond = {}, {}
    for start, part in numbers.groupby(["S", "loading"]):
        there = part[part["x"].between(*_ENOUGH)]
        e = (there if len(there) else part)["ours"].max()
        error[start], beyond[start] = e / _norm(square), e / part["ours"].iloc[-1]
    return measured("M-C2.enough", error=error, beyond=beyond)


def _more(numbers: pd.DataFrame, square: SquareRuns, seeds: range) -> Finding:
    """E with four times as many markers over E, the largest of all numbers; from random positions of the means."""

    def largest(e: pd.Series) -> float:
        return max(e[_TIMES_MORE * n] / e[n] for n in e.index if _TIMES_MORE * n in e.index)

    by_start = numbers.groupby(["S", "loading"])
    one = {start: part.set_index("N")["ours"] for start, part in by_start}
    means = dict(one)
    for (shape, loading), e in one.items():
        if loading == LOADINGS["random"]:
            counts = [int(n) for n in e.index]
            each = (pd.DataFrame(rows(square, shape, "random", s, counts)) for s in seeds)
            errors = pd.concat([of.set_index("N")["ours"] for of in each], axis=1)
            means[shape, loading] = errors.mean(axis=1)
    others = {"one seed alone": {"ratio": {start: largest(e) for start, e in one.items()}}}
    ratio = {start: largest(e) for start, e in means.items()}
    return measured("M-C2.more", ratio=ratio, others=others)


def _per_support() -> Finding:
    """Part of the error that is due to finite h, with N / eps or N eps kept, over a factor of four in eps."""

    def spread(power: int) -> float:
        supports = (0.5, 1.0, 2.0)
        parts = [lattice_error("S4", e, 2.0 * 14.0 / (112.0 * e**power))[1] for e in supports]
        return max(parts) / min(parts)

    return measured("M-C2.per_support", quotient=spread(1), product=spread(-1))


def _parameters(square: SquareRuns, seed: int) -> Iterator[Finding]:
    """What changes E of S8 from midpoints; Euler's method with the hat; and whether dt must follow a small F."""

    def error(**changes: Any) -> float:
        return float(square.having(**changes).trace("S8", "midpoints", follow=False).error[-1])

    base = error()
    at_random = square.trace("S8", "random", seed, follow=False)
    other = {
        "half as many markers": error(markers=square.markers // 2),
        "a time step five times as large": error(dt=5.0 * square.dt),
        "random positions": at_random.error[-1] if at_random.run else 2.0 * base,
        "Euler's method": _euler(square, "S8"),
    }
    change = {name: abs(e / base - 1.0) for name, e in other.items()}
    yield measured("M-C2.influence", change=change)
    e = _euler(square, "S2") / _norm(square)
    guess = np.linalg.norm(SQUARE.value(square.z) - square.exact) / np.linalg.norm(square.exact)
    yield measured("M-C2.crude", ratio=e / guess, error=e)
    end = square.trace("S8", "midpoints", follow=False).end
    f, v = end.field(), np.abs(end.velocity(end.x, end.weights))
    fast = v[f < 0.1 * f.max()].max(initial=0.0) / v[f > 0.5 * f.max()].max()
    yield measured("M-C5.velocity", ratio=fast)
    finer = square.having(dt=0.25 * square.dt).trace("S8", "midpoints", follow=False)
    moved, low = np.abs(end.x - finer.end.x) / square.support, f < 0.1 * f.max()
    yield measured(
        "M-C5.step",
        change=abs(finer.error[-1] / base - 1.0),
        tail=moved[low].max(initial=0.0),
        core=moved[~low].max(),
    )


def _euler(square: SquareRuns, name: str) -> float:
    """E at the end by Euler's method, from midpoints."""
    x, w = load("midpoints", square.markers)
    velocity = MarkerVelocity(shape_function(name), square.support)
    for _ in range(round(square.t_final / square.dt)):
        x = x + square.dt * velocity(x, w)
    return square.relative_error(velocity.fields(x, w, square.z)[0]) * _norm(square)
