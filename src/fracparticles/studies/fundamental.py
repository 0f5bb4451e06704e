"""Appendix A: the mean radius, the two representations of the Green's function, and our own evaluation of it."""

from __future__ import annotations

from math import pi
from time import perf_counter
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.special import gammaln

from fracparticles.claims import Finding
from fracparticles.special import green_asymptotic, green_series, mean_radius as closed_form, reduced_green
from fracparticles.studies.common import Inputs, Result, statement, value

__all__ = ["SplitRadius", "expansions", "fundamental_solution", "inner_moment", "mean_radius", "outer_moment", "split_radius"]

_ROUNDING = 2.0**-53


# --- the mean radius (Table A.4) --------------------------------------------------------------------------

_SPLITS = np.geomspace(1.0, 20.0, 400)  # values of M that are tried
_INNER_TERMS, _OUTER_TERMS = 1500, 300
_DIGITS = 5e-4  # half a unit of the last digit that Table A.4 prints


class SplitRadius(NamedTuple):
    """R_alpha from (A.5), with the split M and the numbers of terms of (A.7) and (A.8)."""

    radius: float
    m: float
    inner_terms: int
    outer_terms: int
    bound: float  # of the error: round-off in (A.7), the first term that (A.8) leaves out


def inner_moment(m: float, alpha: float) -> tuple[float, int, float]:
    """Return H_1 = int_0^M x L(x) dx by (A.7), its number of terms and its round-off.

    H_1 = (M / pi) sum_{k>=0} (-1)^k Gamma(1 + (2k+1)/alpha) / (2k+2)! M^(2k+1), until the terms no longer count.
    """
    k = np.arange(_INNER_TERMS)
    size = np.exp(
        gammaln(1.0 + (2.0 * k + 1.0) / alpha) - gammaln(2.0 * k + 3.0) + (2.0 * k + 2.0) * np.log(m)
    ) / pi
    largest = int(size.argmax())
    small = np.flatnonzero(size[largest:] < _ROUNDING * size[largest])
    terms = largest + int(small[0]) if small.size else _INNER_TERMS
    total = ((-1.0) ** k[:terms] * size[:terms])[::-1].sum()
    # Each term carries the rounding of its logarithm's sum, some 10 units.
    return float(total), terms, 10.0 * _ROUNDING * float(size[largest]) + float(size[terms - 1])


def outer_moment(m: float, alpha: float) -> tuple[float, int, float]:
    """Return H_2 = int_M^inf x L(x) dx by (A.8), its number of terms and the bound of the first term left out.

    H_2 = (M / pi) sum_{j>=1} (-1)^j Gamma(1 + alpha j) / (j! (1 - alpha j)) sin(pi alpha j / 2) M^(-j alpha),
    up to the smallest term, its sine not counted.
    """
    j = np.arange(1.0, _OUTER_TERMS + 1.0)
    size = np.exp(gammaln(1.0 + alpha * j) - gammaln(j + 1.0) + (1.0 - alpha * j) * np.log(m))
    size /= pi * (alpha * j - 1.0)
    terms = int(size.argmin())
    signed = -((-1.0) ** j) * np.sin(0.5 * pi * alpha * j) * size
    return float(signed[:terms][::-1].sum()), terms, float(size[terms])


def split_radius(alpha: float) -> SplitRadius:
    """Return R_alpha = 2 (H_1 + H_2), Eq. (A.5), split where the two error bounds add up to the least."""
    best = None
    for m in _SPLITS:
        inner, inner_terms, round_off = inner_moment(float(m), alpha)
        outer, outer_terms, left_out = outer_moment(float(m), alpha)
        bound = 2.0 * (round_off + left_out)
        if outer_terms > 0 and (best is None or bound < best.bound):
            best = SplitRadius(2.0 * (inner + outer), float(m), inner_terms, outer_terms, bound)
    assert best is not None  # noqa: S101  ((A.8) keeps a term at the largest M for every alpha)
    return best


def mean_radius(inputs: Inputs) -> Result:
    """Give R_alpha in closed form and by the paper's sums (A.5), (A.7), (A.8).

    Parameters of the scene: `alpha` (a list). The sums hold if they agree with the closed form to the digits of
    Table A.4 at every alpha.
    """
    printed = inputs.parameters.get("printed", {})
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
                "sums (A.7), (A.8)": split.radius,
                "sums less closed form": split.radius - exact,
                "error bound": split.bound,
                "split M": split.m,
                "terms of (A.7)": split.inner_terms,
                "terms of (A.8)": split.outer_terms,
            }
        )
        findings.append(value(claim, exact))
    table = pd.DataFrame(rows)
    difference = table["sums less closed form"].abs()
    worst = table.loc[difference.idxmax()]
    findings.append(
        statement(
            "L-TA4.series",
            bool((difference <= _DIGITS).all()),
            f"With M and the numbers of terms chosen for the least error, the sums agree with the closed form to "
            f"{difference.max():.1e} or better; the worst is alpha = {worst['alpha']:g}, with M = {worst['split M']:.2f}.",
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
    return [
        statement(
            f"{item}.series",
            bool(len(gaining) > 2 and (np.diff(gaining) > 0.0).all()),
            f"The partial sums are right to {loose} up to x = {_chain(table['terms'], gaining)} terms; from there on "
            "round-off in the large terms of both signs ends it in double precision, not the series.",
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
            f"Right to {loose} are {widest['terms']:g} terms of (A.1) up to x = {far:.3g} and {earliest['terms']:g} terms "
            f"of (A.2) from x = {near:.3g}: M may lie between.",
            "The series ends, in double precision, before the expansion begins.",
        ),
    ]


def _chain(terms: pd.Series, places: pd.Series) -> str:
    pairs = list(zip(places, terms, strict=False))
    shown = [pairs[0], pairs[len(pairs) // 2], pairs[-1]]
    return ", ".join(f"{x:.3g} with {n:g}" for x, n in shown)


def _representations(inputs: Inputs, alpha: float) -> pd.DataFrame:
    rows = [
        {"series": "exact", "terms": 0, "x": x, "y": y}
        for x, y in zip(_SHOWN_X, reduced_green(_SHOWN_X, alpha), strict=True)
    ]
    for name, function in (("series", green_series), ("asymptotic", green_asymptotic)):
        for terms in map(int, inputs.parameters[f"{name}_terms"]):
            with np.errstate(over="ignore"):
                y = function(_SHOWN_X, alpha, terms)
            rows += [
                {"series": name, "terms": terms, "x": a, "y": b} for a, b in zip(_SHOWN_X, y, strict=True)
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
                "ours, largest error": _up(ours.max()),
                "scipy, largest error": theirs.max(),
                "scipy's, at x": x[theirs.argmax()],
                "scipy, median error": np.median(theirs),
                "time, scipy / ours": f"10^{int(np.log10(slow / _time_of_ours(alpha)))}",
            }
        )
        for name, error in (("ours", ours), ("scipy", theirs)):
            series += [
                {"alpha": alpha, "series": name, "x": a, "y": b} for a, b in zip(x, error, strict=True)
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
