"""Appendix A: the mean radius, the two representations of the Green's function, and our own evaluation of it."""

from __future__ import annotations

from math import log, pi
from time import perf_counter
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import brentq
from scipy.special import gammaln

from fracparticles.special import green_asymptotic, green_series, reduced_green
from fracparticles.special import mean_radius as closed_form
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement, value

__all__ = [
    "SplitRadius",
    "expansions",
    "fundamental_solution",
    "inner_moment",
    "mean_radius",
    "outer_moment",
    "split_radius",
]

_ROUNDING = 2.0**-53
_TERM_ROUNDING = 100.0 * _ROUNDING  # of a term whose logarithm is a sum of some hundreds


# --- the mean radius (Table A.4) --------------------------------------------------------------------------

_SPLITS = (1.1, 12.0)  # between which M is sought
_INNER_TERMS, _OUTER_TERMS = 1500, 600
_DIGITS = 5e-4  # half a unit of the last digit that Table A.4 prints


class SplitRadius(NamedTuple):
    """R_alpha from (A.5), with the split M and the numbers of terms of (A.7) and (A.8)."""

    radius: float
    m: float
    inner_terms: int
    outer_terms: int


def _inner_logarithms(m: float, alpha: float) -> np.ndarray:
    """Logarithms of |terms| of (A.7): Gamma(1 + (2k+1)/alpha) / (2k+2)! M^(2k+2) / pi."""
    k = np.arange(_INNER_TERMS)
    growth = gammaln(1.0 + (2.0 * k + 1.0) / alpha) - gammaln(2.0 * k + 3.0)
    return growth + (2.0 * k + 2.0) * log(m) - log(pi)


def _outer_logarithms(m: float, alpha: float) -> np.ndarray:
    """Logarithms of |terms| of (A.8), sine left out: Gamma(1 + alpha j) / (j! (alpha j - 1)) M^(1-alpha j) / pi."""
    j = np.arange(1.0, _OUTER_TERMS + 1.0)
    growth = gammaln(1.0 + alpha * j) - gammaln(j + 1.0) - np.log(alpha * j - 1.0)
    return growth + (1.0 - alpha * j) * log(m) - log(pi)


def inner_moment(m: float, alpha: float) -> tuple[float, int]:
    """Return H_1 = int_0^M x L(x) dx by (A.7), and the number of terms, those that count.

    H_1 = (M / pi) sum_{k>=0} (-1)^k Gamma(1 + (2k+1)/alpha) / (2k+2)! M^(2k+1).
    """
    logarithms = _inner_logarithms(m, alpha)
    terms = 1 + int(np.flatnonzero(logarithms > logarithms.max() + log(_ROUNDING))[-1])
    signs = (-1.0) ** np.arange(terms)
    return float((signs * np.exp(logarithms[:terms]))[::-1].sum()), terms


def outer_moment(m: float, alpha: float) -> tuple[float, int]:
    """Return H_2 = int_M^inf x L(x) dx by (A.8), and the number of terms, those before the smallest.

    H_2 = (M / pi) sum_{j>=1} (-1)^j Gamma(1 + alpha j) / (j! (1 - alpha j)) sin(pi alpha j / 2) M^(-j alpha).
    """
    logarithms = _outer_logarithms(m, alpha)
    terms = int(logarithms.argmin())
    j = np.arange(1.0, terms + 1.0)
    signs = -((-1.0) ** j) * np.sin(0.5 * pi * alpha * j)
    return float((signs * np.exp(logarithms[:terms]))[::-1].sum()), terms


def split_radius(alpha: float) -> SplitRadius:
    """Return R_alpha = 2 (H_1 + H_2), Eq. (A.5), split at the M that leaves the least error.

    Round-off in the largest term of (A.7) grows with M, the smallest term of (A.8), which is what it leaves out,
    falls with M: M is where the two are equal.
    """

    def balance(m: float) -> float:
        return (
            _inner_logarithms(m, alpha).max()
            + log(_TERM_ROUNDING)
            - _outer_logarithms(m, alpha).min()
        )

    m = float(brentq(balance, *_SPLITS, xtol=1e-6))
    inner, inner_terms = inner_moment(m, alpha)
    outer, outer_terms = outer_moment(m, alpha)
    return SplitRadius(2.0 * (inner + outer), m, inner_terms, outer_terms)


def mean_radius(inputs: Inputs) -> Result:
    """Give R_alpha in closed form and by the paper's sums (A.5), (A.7), (A.8).

    Parameters of the scene: `alpha` (a list). The sums hold if they agree with the closed form to the digits of
    Table A.4 at every alpha.
    """
    printed = inputs.printed
    rows, findings = [], []
    for alpha in map(float, inputs.parameters["alpha"]):
        claim, exact, split = f"L-TA4.alpha{alpha:g}", closed_form(alpha), split_radius(alpha)
        text = printed.get(claim)
        rows.append(
            {
                "alpha": alpha,
                "printed": float(text) if text else np.nan,
                "closed form": exact,
                "deviation": exact / float(text) - 1.0 if text else np.nan,
                "sums (A.7), (A.8)": round(split.radius, 5),
                "sums off by less than": _up(abs(split.radius - exact)),
                "split M": split.m,
                "terms of (A.7)": split.inner_terms,
                "terms of (A.8)": split.outer_terms,
            }
        )
        findings.append(value(claim, exact))
    table = pd.DataFrame(rows)
    difference = table["sums off by less than"]
    findings.append(
        statement(
            "L-TA4.series",
            bool((difference <= _DIGITS).all()),
            f"With M and the numbers of terms chosen for the least error, the sums in double precision agree with the "
            f"closed form to {difference.max():g} or better; M runs from {table['split M'].min():.2f} to "
            f"{table['split M'].max():.2f}.",
            "The sums miss the digits of the table at some alpha, whatever M and the numbers of terms.",
        )
    )
    return Result(table, findings)


# --- series and expansion (Figs A.10-A.12) ----------------------------------------------------------------

_TOLERANCES = (1e-3, 1e-6)
_X = np.geomspace(1e-2, 1e7, 9001)
_SHOWN_X = np.geomspace(0.1, 30.0, 301)


def expansions(inputs: Inputs) -> Result:
    """Say how far each partial sum of (A.1) and (A.2) reaches, for one alpha.

    Parameters of the scene: `alpha`; `terms`, the numbers of terms of the table; `series_terms` and
    `asymptotic_terms`, those of the figure. A sum holds where its relative error is below the tolerance, from the
    origin on for (A.1), to infinity for (A.2).
    """
    alpha = float(inputs.parameters["alpha"])
    exact = reduced_green(_X, alpha)
    rows = []
    for terms in map(int, inputs.parameters["terms"]):
        with np.errstate(over="ignore"):
            series = np.abs(green_series(_X, alpha, terms) / exact - 1.0)
            expansion = np.abs(green_asymptotic(_X, alpha, terms) / exact - 1.0)
        row: dict[str, float] = {"terms": terms}
        for tolerance in _TOLERANCES:
            row[f"series to x ({tolerance:g})"] = _holds_up_to(series < tolerance)
            row[f"expansion from x ({tolerance:g})"] = _holds_from(expansion < tolerance)
        rows.append(row)
    table = pd.DataFrame(rows)
    return Result(table, _findings(inputs, alpha, table), _representations(inputs, alpha))


def _holds_up_to(good: np.ndarray) -> float:
    bad = np.flatnonzero(~good)
    if bad.size == 0:
        return float(_X[-1])
    return float(_X[bad[0] - 1]) if bad[0] > 0 else np.nan


def _holds_from(good: np.ndarray) -> float:
    bad = np.flatnonzero(~good)
    if bad.size == 0:
        return float(_X[0])
    return float(_X[bad[-1] + 1]) if bad[-1] + 1 < _X.size else np.nan


def _findings(inputs: Inputs, alpha: float, table: pd.DataFrame) -> list[Finding]:
    item = inputs.items[0]
    loose = f"{_TOLERANCES[0]:g}"
    reach, start = table[f"series to x ({loose})"], table[f"expansion from x ({loose})"]
    widest, earliest = table.loc[reach.idxmax()], table.loc[start.idxmin()]
    # The series gains until its largest terms, rounded, are as large as the tolerance of the sum.
    gaining = reach.iloc[: int(reach.idxmax()) + 1]
    # The expansion gains until the terms left out grow again.
    receding = start.iloc[: int(start.idxmin()) + 1]
    far, near = reach.max(), start.min()
    cancellation = _largest_term(far, alpha) / float(reduced_green(far, alpha))
    return [
        statement(
            f"{item}.series",
            bool(len(gaining) > 2 and (np.diff(gaining) > 0.0).all()),
            f"The partial sums are right to {loose} up to x = {_chain(table['terms'], gaining)} terms. There its "
            f"largest term is {cancellation:.0e} times the sum: round-off in double precision ends it, not the series.",
            "More terms do not make the partial sums hold further from the origin.",
        ),
        statement(
            f"{item}.asymptotic",
            bool(start.notna().all() and len(receding) > 2 and (np.diff(receding) < 0.0).all()),
            f"The sums are right to {loose} from x = {_chain(table['terms'], receding)} terms; beyond that number the "
            "start moves outwards again, as that of a divergent expansion must.",
            "The sums of (A.2) do not approach the function for large x.",
        ),
        statement(
            f"{item}.overlap",
            bool(far >= near),
            f"Right to {loose} are {widest['terms']:g} terms of (A.1) up to x = {far:.3g} and "
            f"{earliest['terms']:g} terms "
            f"of (A.2) from x = {near:.3g}: M may lie between.",
            "The series ends, in double precision, before the expansion begins.",
        ),
    ]


def _largest_term(x: float, alpha: float) -> float:
    """Greatest |term| of (A.1), Gamma(1 + m/alpha) x^(m-1) / (pi m!)."""
    m = np.arange(1.0, 2.0 * _INNER_TERMS, 2.0)
    return float(
        np.exp((gammaln(1.0 + m / alpha) - gammaln(m + 1.0) + (m - 1.0) * log(x)).max()) / pi
    )


def _chain(terms: pd.Series, places: pd.Series) -> str:
    pairs = list(zip(places, terms, strict=False))
    shown = [pairs[0], pairs[len(pairs) // 2], pairs[-1]]
    return ", ".join(f"{x:.3g} with {n:g}" for x, n in shown)


def _representations(inputs: Inputs, alpha: float) -> pd.DataFrame:
    rows = [
        {"series": "exact", "terms": 0, "x": x, "y": y}
        for x, y in zip(_SHOWN_X, np.asarray(reduced_green(_SHOWN_X, alpha)), strict=True)
    ]
    for name, function in (("series", green_series), ("asymptotic", green_asymptotic)):
        for terms in map(int, inputs.parameters[f"{name}_terms"]):
            with np.errstate(over="ignore"):
                y = np.asarray(function(_SHOWN_X, alpha, terms))
            rows += [
                {"series": name, "terms": terms, "x": a, "y": b}
                for a, b in zip(_SHOWN_X, y, strict=True)
            ]
    return pd.DataFrame(rows)


# --- our evaluation ---------------------------------------------------------------------------------------

_TIMED_POINTS = 100_000
_REPEATS = 5


def fundamental_solution(inputs: Inputs) -> Result:
    """Compare `reduced_green` and scipy's `levy_stable` with reference values of 25 digits.

    Parameters of the scene: `reference`, a CSV file with alpha, x and density; tools/make_stable_reference.py
    writes it. Times are given as an order of magnitude only.
    """
    from scipy.stats import levy_stable

    reference = pd.read_csv(inputs.parameters["reference"])
    rows, series = [], []
    for alpha, points in reference.groupby("alpha"):
        x, exact = points["x"].to_numpy(), points["density"].to_numpy()
        ours = np.abs(reduced_green(x, alpha) / exact - 1.0)
        start = perf_counter()
        theirs = np.abs(levy_stable.pdf(x, alpha, 0.0) / exact - 1.0)
        slow = (perf_counter() - start) / x.size
        rows.append(
            {
                "alpha": alpha,
                "points": x.size,
                "ours, error below": _up(ours.max()),
                "scipy, largest error": theirs.max(),
                "scipy's, at x": x[theirs.argmax()],
                "scipy, median error": np.median(theirs),
                "time, scipy / ours": f"10^{int(np.log10(slow / _time_of_ours(alpha)))}",
            }
        )
        for name, error in (("ours", ours), ("scipy", theirs)):
            series += [
                {"alpha": alpha, "series": name, "x": a, "y": b}
                for a, b in zip(x, error, strict=True)
            ]
    return Result(pd.DataFrame(rows), series=pd.DataFrame(series))


def _up(error: float) -> float:
    """The next power of ten: of an error at round-off only its size is reproducible."""
    return float(10.0 ** np.ceil(np.log10(max(error, _ROUNDING))))


def _time_of_ours(alpha: float) -> float:
    """Least time per point of some runs over many points, the table of alpha already made."""
    x = np.linspace(0.0, 100.0, _TIMED_POINTS)
    times = []
    for _ in range(_REPEATS):
        start = perf_counter()
        reduced_green(x, alpha)
        times.append(perf_counter() - start)
    return min(times) / _TIMED_POINTS
