"""Figs A.10-A.12: how far the series (A.1) and the asymptotic expansion (A.2) of the Green's function reach."""

from __future__ import annotations

from math import log, pi

import numpy as np
import pandas as pd
from scipy.special import gammaln

from fracparticles.special import green_asymptotic, green_series, reduced_green
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

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
    exact = np.asarray(reduced_green(_X, alpha))
    rows = []
    for count in terms:
        series, expansion = (_off(name, alpha, count, exact) for name in _FUNCTIONS)
        row: dict[str, float] = {"terms": count}
        for tolerance in _TOLERANCES:
            row[f"series to x ({tolerance:g})"] = _holds_up_to(_X, series < tolerance)
            row[f"expansion from x ({tolerance:g})"] = _holds_up_to(
                _X[::-1], (expansion < tolerance)[::-1]
            )
        rows.append(row)
    table = pd.DataFrame(rows)
    curves = [("exact", 0, np.asarray(reduced_green(_SHOWN_X, alpha)))]
    for name, counts in (("series", series_terms), ("asymptotic", asymptotic_terms)):
        curves += [(name, count, _sum(name, _SHOWN_X, alpha, count)) for count in counts]
    shown = [
        pd.DataFrame({"series": name, "terms": count, "x": _SHOWN_X, "y": y})
        for name, count, y in curves
    ]
    findings = _findings(inputs.items[0], alpha, table) if inputs.items else []
    return Result(table, findings, pd.concat(shown, ignore_index=True))


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


def _findings(item: str, alpha: float, table: pd.DataFrame) -> list[Finding]:
    loose = f"{_TOLERANCES[0]:g}"
    reach, start = table[f"series to x ({loose})"], table[f"expansion from x ({loose})"]
    widest, earliest = reach.idxmax(), start.idxmin()
    # The series gains until its largest terms, rounded, are as large as the tolerance of the sum; the expansion gains
    # until the terms left out grow again.
    gaining, receding = reach.iloc[: int(widest) + 1], start.iloc[: int(earliest) + 1]
    far, near, terms = reach.max(), start.min(), table["terms"]
    cancellation = _largest_term(far, alpha) / float(reduced_green(far, alpha))
    gains = len(gaining) > 2 and (np.diff(gaining) > 0.0).all()
    recedes = start.notna().all() and len(receding) > 2 and (np.diff(receding) < 0.0).all()
    return [
        statement(
            f"{item}.series",
            gains,
            f"The partial sums are right to {loose} up to x = {_chain(terms, gaining)} terms. There its "
            f"largest term is {cancellation:.0e} times the sum: round-off in double precision ends it, not the series.",
            "More terms do not make the partial sums hold further from the origin.",
        ),
        statement(
            f"{item}.asymptotic",
            recedes,
            f"The sums are right to {loose} from x = {_chain(terms, receding)} terms; beyond that number the "
            "start moves outwards again, as that of a divergent expansion must.",
            "The sums of (A.2) do not approach the function for large x.",
        ),
        statement(
            f"{item}.overlap",
            far >= near,
            f"Right to {loose} are {terms[widest]:g} terms of (A.1) up to x = {far:.3g} and {terms[earliest]:g} terms "
            f"of (A.2) from x = {near:.3g}: M may lie between.",
            "The series ends, in double precision, before the expansion begins.",
        ),
    ]


def _largest_term(x: float, alpha: float) -> float:
    """Greatest |term| of (A.1), Gamma(1 + m/alpha) x^(m-1) / (pi m!)."""
    m = np.arange(1.0, 3000.0, 2.0)
    logarithms = gammaln(1.0 + m / alpha) - gammaln(m + 1.0) + (m - 1.0) * log(x)
    return float(np.exp(logarithms.max()) / pi)


def _chain(terms: pd.Series, places: pd.Series) -> str:
    """The first, the middle and the last place, with the numbers of terms."""
    pairs = list(zip(places, terms, strict=False))
    shown = [pairs[0], pairs[len(pairs) // 2], pairs[-1]]
    return ", ".join(f"{x:.3g} with {n:g}" for x, n in shown)
