"""Figs A.10-A.12: how far the series (A.1) and the asymptotic expansion (A.2) of the Green's function reach."""

from collections.abc import Iterator
from math import log, pi
from typing import NamedTuple, Self

import numpy as np
import pandas as pd
from scipy.special import gammaln

from fracparticles.special import green_asymptotic, green_series, reduced_green
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_TOLERANCES = (1e-3, 1e-6)
_X = np.geomspace(1e-2, 1e7, 9001)
_SHOWN_X = np.geomspace(0.1, 30.0, 301)
_FUNCTIONS = {"series": green_series, "asymptotic": green_asymptotic}


def study(
    inputs: Inputs,
    *,
    alpha: float,
    terms: list[int],
    series_terms: list[int],
    asymptotic_terms: list[int],
) -> Result:
    """Say how far each partial sum of (A.1) and (A.2) reaches, for one alpha.

    A sum of so many `terms` holds where its relative error is below the tolerance, from the origin on for (A.1), to
    infinity for (A.2). `series_terms` and `asymptotic_terms` are those of the figure.
    """
    exact, rows = np.asarray(reduced_green(_X, alpha)), []
    for count in terms:
        series, expansion = (_off(name, alpha, count, exact) for name in _FUNCTIONS)
        row: dict[str, float] = {"terms": count}
        for tolerance in _TOLERANCES:
            near, far = series < tolerance, expansion < tolerance
            row[f"series to x ({tolerance:g})"] = _holds_up_to(_X, near)
            row[f"expansion from x ({tolerance:g})"] = _holds_up_to(_X[::-1], far[::-1])
        rows.append(row)
    table = pd.DataFrame(rows)
    panels = Panels()
    panels.add(series="exact", terms=0, x=_SHOWN_X, y=reduced_green(_SHOWN_X, alpha))
    for name, counts in (("series", series_terms), ("asymptotic", asymptotic_terms)):
        for count in counts:
            y = _sum(name, _SHOWN_X, alpha, count)
            panels.add(series=name, terms=count, x=_SHOWN_X, y=y)
    findings = [*_findings(inputs.items[0], alpha, table)] if inputs.items else []
    return Result(table, findings, panels.frame)


def _sum(name: str, x: np.ndarray, alpha: float, terms: int) -> np.ndarray:
    with np.errstate(over="ignore"):
        return np.asarray(_FUNCTIONS[name](x, alpha, terms))


def _off(name: str, alpha: float, terms: int, exact: np.ndarray) -> np.ndarray:
    """The relative error of a partial sum."""
    with np.errstate(over="ignore"):
        return np.abs(_sum(name, _X, alpha, terms) / exact - 1.0)


def _holds_up_to(x: np.ndarray, good: np.ndarray) -> float:
    """The last x before the first that is not good."""
    bad = np.flatnonzero(~good)
    last = bad[0] - 1 if bad.size else -1
    return np.nan if bad.size and last < 0 else float(x[last])


def _findings(item: str, alpha: float, table: pd.DataFrame) -> Iterator[Finding]:
    """How far the sums reach. A reach is followed as terms are added until it no longer grows.

    The series gains until its largest terms, rounded, are as large as the tolerance of the sum; the expansion gains
    until the terms left out grow again.
    """
    loose, strict = (_Reach.of(table, f"{tolerance:g}") for tolerance in _TOLERANCES)
    x = np.array([0.25, 0.5])
    right, left = (_literal_series(sign * x, alpha) for sign in (1.0, -1.0))
    even = np.abs(left / right - 1.0).max()
    printed = np.abs(right / np.asarray(reduced_green(x, alpha)) - 1.0).max()
    far, near, terms = loose.far, loose.near, table["terms"]
    yield measured(
        f"{item}.series",
        gain=_gains(loose.series),
        reach=_chain(terms, loose.series),
        cancellation=_largest_term(far, alpha) / float(reduced_green(far, alpha)),
    )
    yield measured(f"{item}.even", even=even, printed=printed)
    start = _chain(terms, loose.expansion)
    yield measured(f"{item}.asymptotic", gain=_gains(1.0 / loose.expansion), start=start)
    others = {f"sums that are right to {_TOLERANCES[1]:g}": {"ratio": strict.far / strict.near}}
    yield measured(f"{item}.overlap", ratio=far / near, far=far, near=near, others=others)


class _Reach(NamedTuple):
    """By number of terms: up to which x the series holds, and from which the expansion, until more make them worse."""

    series: pd.Series
    expansion: pd.Series

    @classmethod
    def of(cls, table: pd.DataFrame, tolerance: str) -> Self:
        reach, start = table[f"series to x ({tolerance})"], table[f"expansion from x ({tolerance})"]
        last, first = (max(int(k), 1) + 1 for k in (reach.idxmax(), start.idxmin()))
        return cls(reach.iloc[:last], start.iloc[:first])

    @property
    def far(self) -> float:
        return float(self.series.max())

    @property
    def near(self) -> float:
        return float(self.expansion.min())


def _gains(reach: pd.Series) -> float:
    """The least ratio of a reach to the one with fewer terms."""
    return float((reach.iloc[1:].to_numpy() / reach.iloc[:-1].to_numpy()).min())


def _literal_series(x: np.ndarray, alpha: float) -> np.ndarray:
    """200 terms of (A.1) as printed: 1/(x pi) sum (-x)^m Gamma(1 + m/alpha) / m! sin(-m pi / 2)."""
    m = np.arange(1.0, 201.0)
    size = np.exp(gammaln(1.0 + m / alpha) - gammaln(m + 1.0))
    return ((-x[:, None]) ** m * size * np.sin(-0.5 * pi * m)).sum(axis=1) / (x * pi)


def _largest_term(x: float, alpha: float) -> float:
    """Greatest |term| of (A.1), Gamma(1 + m/alpha) x^(m-1) / (pi m!)."""
    m = np.arange(1.0, 3000.0, 2.0)
    logarithms = gammaln(1.0 + m / alpha) - gammaln(m + 1.0) + (m - 1.0) * log(x)
    return float(np.exp(logarithms.max()) / pi)


def _chain(terms: pd.Series, places: pd.Series) -> dict[str, float]:
    """The first, the middle and the last place, by the number of terms."""
    shown = sorted({0, len(places) // 2, len(places) - 1})
    return {f"{terms.iloc[k]:g} terms": places.iloc[k] for k in shown}
