"""Table A.4: the mean radius R_alpha in closed form, and by the paper's sums (A.5), (A.7), (A.8)."""

from functools import partial
from math import log, pi
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import brentq
from scipy.special import gammaln, roots_legendre

from fracparticles.special import mean_radius, reduced_green
from fracstudy.errors import power_of_ten
from fracstudy.findings import each, measured
from fracstudy.inputs import Inputs, Result

_ROUNDING = 2.0**-53
_TERM_ROUNDING = 100.0 * _ROUNDING  # of a term whose logarithm is a sum of some hundreds
_SPLITS = (1.1, 12.0)  # between which M is sought
_INNER_TERMS, _OUTER_TERMS = 1500, 600


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
        round_off = _inner_logarithms(m, alpha).max() + log(_TERM_ROUNDING)
        return round_off - _outer_logarithms(m, alpha).min()

    m = float(brentq(balance, *_SPLITS, xtol=1e-6))
    inner, inner_terms = inner_moment(m, alpha)
    outer, outer_terms = outer_moment(m, alpha)
    return SplitRadius(2.0 * (inner + outer), m, inner_terms, outer_terms)


def study(inputs: Inputs, *, alpha: list[float]) -> Result:
    """Give R_alpha in closed form and by the sums, and measure which moments of L_alpha^0 are finite."""
    claims = {f"L-TA4.alpha{a:g}": a for a in alpha}
    table = pd.DataFrame([_row(a, inputs.printed.get(claim)) for claim, a in claims.items()])
    by_alpha = table.set_index("alpha")
    splits = by_alpha["split M"]
    halves = {a: _quadrature(m, a) for a, m in splits.items()}

    def inner_off(a: float) -> float:
        return abs(inner_moment(splits[a], a)[0] - halves[a])

    def outer_off(a: float) -> float:
        return abs(outer_moment(splits[a], a)[0] - 0.5 * mean_radius(a) + halves[a])

    first, second = (each(partial(_tail_share, power=p), alpha=alpha) for p in (1, 2))
    inner, outer = each(inner_off, alpha=alpha), each(outer_off, alpha=alpha)
    ours = zip(claims, table["closed form"], strict=True)
    findings = [
        *(measured(claim, ours=value) for claim, value in ours),
        measured("L-TA4.series", difference=by_alpha["sums off by less than"], split=splits),
        measured("L-TA4.moments", inner=inner, outer=outer),
        measured("L-TA4.second_moment", second=second, first=first),
        measured("L-TA4.unit_mass", difference=each(_mass_error, alpha=alpha)),
    ]
    return Result(table, inputs.judged(findings))


def _quadrature(m: float, alpha: float) -> float:
    """H_1 of (A.6) by Gauss-Legendre."""
    node, weight = roots_legendre(60)
    x = 0.5 * m * (node + 1.0)
    return 0.5 * m * float((x * reduced_green(x, alpha)) @ weight)


def _tail_share(alpha: float, power: int) -> float:
    """The part of int x^power L(x) dx in the decade from 1e6, over that in the one before."""
    log_x, weight = roots_legendre(60)
    x = 10.0 ** (5.5 + 0.5 * log_x + np.arange(2.0)[:, None])
    before, last = (x ** (power + 1.0) * reduced_green(x, alpha)) @ weight
    return float(last / before)


def _mass_error(alpha: float) -> float:
    """|int L dx - 1|, Gauss-Legendre in log x between 1e-9 and 1e12, with what lies beyond from L and its power law."""
    low, high = -9.0, 12.0
    node, weight = roots_legendre(1000)
    x = 10.0 ** (low + 0.5 * (high - low) * (node + 1.0))
    inside = 0.5 * (high - low) * log(10.0) * float((x * reduced_green(x, alpha)) @ weight)
    near, far = (float(reduced_green(x, alpha)) for x in (0.0, 10.0**high))
    return abs(2.0 * (inside + (10.0**low * near + 10.0**high / alpha * far)) - 1.0)


def _row(alpha: float, printed: str | None) -> dict[str, float]:
    exact, split = mean_radius(alpha), split_radius(alpha)
    theirs = float(printed) if printed else np.nan
    return {
        "alpha": alpha,
        "printed": theirs,
        "closed form": exact,
        "deviation": exact / theirs - 1.0,
        "sums (A.7), (A.8)": round(split.radius, 5),
        "sums off by less than": power_of_ten(split.radius - exact, _ROUNDING),
        "split M": split.m,
        "terms of (A.7)": split.inner_terms,
        "terms of (A.8)": split.outer_terms,
    }
