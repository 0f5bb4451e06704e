"""Table 3: the stability limit, the spectrum behind it, and whether (54) is the criterion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.linalg import expm

from fracparticles.lattice.dense import Spectrum, norms_of_powers, spectrum
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix, power_iteration
from fracparticles.schemes.stability import stability_limit
from fracparticles.time import STEP_POLYNOMIALS
from fracstudy.claims import Finding, judge_value, unit_of_last_digit
from fracstudy.inputs import ORDERS, Inputs, Result, listed, statement, value

__all__ = ["study", "truncated_print"]

_SCHEMES = ("DD", "FPSE", "KPSE")
_STEPS = ("euler", "rk2")
_OVERLAP = 2.0
_ROUND_OFF = 1e-12  # relative to |lambda_min|: N roundings of the matrix's entries
_BELOW, _ABOVE = 0.99, 1.01  # steps on either side of the limit (54)
# Norms of powers: n = 2^0, 2^4, .. 2^36 below the limit, n = 2^10 above. The roundings of 36 squarings
# add up to 2^36 1e-16, 1e-5 in all.
_SQUARINGS, _EVERY, _FEW_SQUARINGS = 36, 4, 10
_SATURATED = 0.01
_GROWN = 1e6
# What the words of Sec. 4.4 are taken to mean.
_SEVERAL = 2.0
_SIGNIFICANT = 0.25
_COMPARABLE = 10.0
# The values of beta of the curves.
_BETAS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)


def _matrix(scheme: str, alpha: float, order: int, particles: int) -> np.ndarray:
    setting = Setting(n=particles // 2, spacing=1.0, alpha=alpha, order=order, overlap=_OVERLAP)
    return dense_matrix(SCHEMES[scheme].operator(setting))


class _Growth(NamedTuple):
    below: float  # greatest norm of p(A dt)^n below the limit
    flow: float  # greatest norm of exp(n dt A), the same times
    saturated: bool  # whether the norm stops growing
    above: float  # norm of p(A dt)^1024 above the limit


def _growths(a: np.ndarray, lowest: float) -> dict[str, _Growth]:
    """Norms of the powers of one step just below and just above dt = 2 / |lambda_min|, Eq. (54)."""
    below, above = (share * 2.0 / abs(lowest) * a for share in (_BELOW, _ABOVE))
    flow = max(norms_of_powers(expm(below), _SQUARINGS, _EVERY))
    growths = {}
    for integrator in _STEPS:
        norms = norms_of_powers(_step(below, integrator), _SQUARINGS, _EVERY)
        last = norms_of_powers(_step(above, integrator), _FEW_SQUARINGS, _FEW_SQUARINGS)[-1]
        saturated = norms[-1] <= (1.0 + _SATURATED) * norms[-2]
        growths[integrator] = _Growth(max(norms), flow, saturated, last)
    return growths


def _step(z: np.ndarray, integrator: str) -> np.ndarray:
    """p(z), z = A dt, Eq. (52)."""
    one = np.eye(len(z))
    return one + z if integrator == "euler" else one + z + 0.5 * z @ z


def truncated_print(printed: str, ours: float) -> bool:
    """Return whether the print holds our digits cut off where rounding would have changed the last one."""
    unit = unit_of_last_digit(printed)
    cut = Fraction(ours) // unit * unit
    return cut == Fraction(printed) and Fraction(ours) - cut > unit / 2


def study(
    inputs: Inputs,
    *,
    beta: list[float],
    truncation: float,
    spacing: list[float],
    tolerance: float,
    dense: list[int],
) -> Result:
    """Give the limit a of (55) four ways, and judge what Sec. 4.4 says of the matrix A.

    - from the symbol, on the infinite lattice, and in closed form with the aliases neglected;
    - by power iteration to the `tolerance` on the paper's lattice, of `truncation` and a `spacing` for each beta, and
      from all eigenvalues of small ones, `dense` particles, at least two numbers.
    """
    size = sorted(dense)[-2]
    spectra = {
        (scheme, b, order): [spectrum(_matrix(scheme, 1.0 + b, order, n)) for n in sorted(dense)]
        for b in beta
        for scheme in (*_SCHEMES, "GPSE")
        for order in ORDERS
        if order in SCHEMES[scheme].orders
    }
    iterated = {
        (scheme, b): _iterate(scheme, b, h, truncation, tolerance)
        for b, h in zip(beta, spacing, strict=True)
        for scheme in _SCHEMES
    }
    rows = [
        _row(*key, of_key[-1], iterated.get(key[:2]), inputs.printed)
        for key, of_key in spectra.items()
    ]
    limits = {(s, b): stability_limit(s, b) for s in _SCHEMES for b in beta}
    growths = {
        (s, b): _growths(_matrix(s, 1.0 + b, 2, size), spectra[s, b, 2][-2].lowest)
        for s in _SCHEMES
        for b in beta
    }
    findings = [
        *(_print(*key, limit, iterated[key], inputs.printed) for key, limit in limits.items()),
        *_words(limits, beta),
        _same_step(growths, size),
        *_matrices(
            {(s, b): of_key for (s, b, order), of_key in spectra.items() if order == 2}, beta
        ),
        *(_criterion(scheme, growths, size) for scheme in _SCHEMES),
        *_trends(beta),
    ]
    return Result(pd.DataFrame(rows), findings, _series(beta, inputs.printed))


def _iterate(
    scheme: str, beta: float, h: float, truncation: float, tolerance: float
) -> tuple[float, int]:
    """a by power iteration, and the number of iterations."""
    given = {"scheme": scheme, "beta": beta, "truncation": truncation, "spacing": h}
    setting = Case(**given, integrator="exponential").setting
    operator = SCHEMES[scheme].operator(setting)
    eigenvalue, iterations = power_iteration(operator, tolerance=tolerance)
    return -2.0 * setting.rate / eigenvalue, iterations


def _size(value: float) -> str:
    """A ratio in words: the last digits of round-off are nobody's result."""
    return f"{value:.1e}" if abs(value) > _ROUND_OFF else f"less than {_ROUND_OFF:g}"


def _row(
    scheme: str,
    beta: float,
    order: int,
    dense: Spectrum,
    iterated: tuple[float, int] | None,
    printed: Mapping[str, str],
) -> dict[str, object]:
    limit = stability_limit(scheme, beta, order)
    text = printed.get(f"L-T3.{scheme}.beta{beta:g}") if order == 2 else None
    paper = order == 2 and iterated
    status = judge_value(text, limit) if text else None
    theirs = float(text) if text else np.nan
    ratio = dense.highest / abs(dense.lowest)
    return {
        "beta": beta,
        "scheme": scheme,
        "order": ORDERS[order],
        "printed": theirs,
        "symbol": limit,
        "closed form": SCHEMES[scheme].closed_form_limit(beta, _OVERLAP) if paper else np.nan,
        "power iteration": paper[0] if paper else np.nan,
        f"eigenvalues, N = {dense.particles}": -2.0 / dense.lowest,
        "deviation": limit / theirs - 1.0,
        "status": f"{status.sign} {status}" if status else "",
        "RK4": 0.5 * STEP_POLYNOMIALS["rk4"].stability_interval * limit,
        "largest / least eigenvalue": ratio if abs(ratio) > _ROUND_OFF else 0.0,
        "asymmetry": dense.asymmetry if dense.asymmetry > _ROUND_OFF else 0.0,
    }


def _print(
    scheme: str, beta: float, limit: float, iterated: tuple[float, int], printed: Mapping[str, str]
) -> Finding:
    name = f"L-T3.{scheme}.beta{beta:g}"
    if name not in printed or not truncated_print(printed[name], limit):
        return value(name, limit)
    reason = (
        f"Printed truncated, not rounded: the symbol gives {limit:.4f}, and power iteration comes down to it "
        f"from above ({iterated[0]:.4f} after {iterated[1]} iterations)."
    )
    return value(name, limit, reason)


def _words(limits: dict[tuple[str, float], float], betas: list[float]) -> list[Finding]:
    dd, fpse, kpse = of_scheme = [np.array([limits[s, b] for b in betas]) for s in _SCHEMES]
    over_dd, over_kpse = fpse / dd, fpse / kpse
    spread = {s: max(a) / min(a) - 1.0 for s, a in zip(_SCHEMES, of_scheme, strict=True)}
    widest = max(spread, key=spread.__getitem__)
    each = ", ".join(f"{100 * v:.0f} % ({s})" for s, v in spread.items())
    at = f"at beta = {listed(betas)}"
    spans = f"from beta = {betas[0]:g} to {betas[-1]:g}"
    dd_, fpse_, kpse_, over_dd_, over_kpse_ = (
        listed(a, ".2f") for a in (dd, fpse, kpse, over_dd, over_kpse)
    )
    return [
        statement(
            "L-T3.ordering",
            (kpse < dd).all() and (dd < fpse).all(),
            f"KPSE {kpse_}, DD {dd_}, FPSE {fpse_} {at}.",
            "The limits are in another order at some beta.",
        ),
        statement(
            "L-T3.several_times",
            over_dd.min() > _SEVERAL and over_kpse.min() > _SEVERAL,
            f"FPSE's limit is {over_kpse_} times that of KPSE, but {over_dd_} times that of DD, {at}; "
            f"several is taken as more than {_SEVERAL:g}.",
            "Of KPSE it is true, of DD not: in closed form the ratio to DD is 2^(alpha/2), less than 2.",
        ),
        statement(
            "L-T3.weak_in_beta",
            max(spread.values()) < _SIGNIFICANT,
            f"The limit varies by {each} {spans}; significant is taken as more than {100 * _SIGNIFICANT:.0f} %.",
            f"True of the others, not of {widest}: its limit varies by {100 * spread[widest]:.0f} % {spans}.",
        ),
        statement(
            "L-T3.comparable",
            over_kpse.max() < _COMPARABLE,
            f"The largest limit is {over_kpse_} times the smallest {at}; comparable is taken as within a factor of "
            f"{_COMPARABLE:g}.",
            "The limits differ by more than an order of magnitude.",
        ),
    ]


def _same_step(growths: dict[tuple[str, float], dict[str, _Growth]], size: int) -> Finding:
    every = list(growths.values())
    below = {i: max(one[i].below for one in every) for i in _STEPS}
    above = {i: min(one[i].above for one in every) for i in _STEPS}
    stable = all(growth.saturated for one in every for growth in one.values())
    return statement(
        "L-T3.rk1_rk2",
        stable and min(above.values()) > _GROWN,
        f"With all three schemes on {size} particles, the powers of a step at {_BELOW:g} of 2/|lambda_min| stay "
        f"bounded (RK1 {below['euler']:.3g}, RK2 {below['rk2']:.3g}), and 1024 steps at {_ABOVE:g} of it grow by at "
        f"least {above['euler']:.1e} (RK1) and {above['rk2']:.1e} (RK2).",
        "RK1 and RK2 lose stability at different steps.",
    )


def _matrices(
    spectra: dict[tuple[str, float], list[Spectrum]], betas: list[float]
) -> list[Finding]:
    """What Sec. 4.4 says of A, order II, the worst over beta."""

    def worst(scheme: str, quantity: Callable[[Spectrum], float], k: int = -1) -> float:
        return max(quantity(spectra[scheme, b][k]) for b in betas)

    sizes = [s.particles for s in spectra["DD", betas[0]]]
    at = f"at N = {sizes[-1]}"
    findings = []
    for scheme in _SCHEMES:
        asymmetries = [worst(scheme, lambda s: s.asymmetry, k) for k in range(len(sizes))]
        symmetric = asymmetries[-1] <= _ROUND_OFF
        each = ", ".join(f"{a:.2f} (N = {n})" for a, n in zip(asymmetries, sizes, strict=True))
        departure = _size(worst(scheme, lambda s: s.departure))
        findings.append(
            statement(
                f"L-C12.symmetric.{scheme}",
                symmetric,
                f"|A - A^T| / |A| is {_size(asymmetries[-1]) if symmetric else each}, the largest over beta; "
                f"|A A^T - A^T A| / |A|^2 is {departure} {at}.",
                "A is the product of two sums that do not commute where the lattice ends: the asymmetry falls like "
                "N^(-1/2), as that of a number of rows that does not grow with N.",
            )
        )
    for scheme in ("FPSE", "KPSE"):
        highest = worst(scheme, lambda s: abs(s.highest / s.lowest))
        findings.append(
            statement(
                f"L-C12.max_zero.{scheme}",
                highest <= _ROUND_OFF,
                f"The largest eigenvalue is {_size(highest)} times |lambda_min| in modulus {at}.",
                "The largest eigenvalue is not 0.",
            )
        )
    imaginary = worst("FPSE", lambda s: s.imaginary / abs(s.lowest))
    highest = worst("DD", lambda s: s.highest / abs(s.lowest))
    return [
        *findings,
        statement(
            "L-C12.real.FPSE",
            imaginary <= _ROUND_OFF,
            f"The imaginary parts are {_size(imaginary)} times |lambda_min| {at}, although A is not symmetric.",
            "Some eigenvalues are complex.",
        ),
        statement(
            "L-C12.max_negative.DD",
            highest < -_ROUND_OFF,
            f"The largest eigenvalue is {highest:.1e} |lambda_min| {at}.",
            "The largest eigenvalue of DD is not negative.",
        ),
    ]


def _criterion(
    scheme: str, growths: dict[tuple[str, float], dict[str, _Growth]], size: int
) -> Finding:
    mine = [growth for (s, _), one in growths.items() if s == scheme for growth in one.values()]
    below, flow = max(g.below for g in mine), max(g.flow for g in mine)
    above = min(g.above for g in mine)
    # Bounded, and by no more than the exact flow itself.
    faithful = all(g.saturated and g.below <= (1.0 + _SATURATED) * g.flow for g in mine)
    remark = (
        f" The norm is that of the exact flow exp(t A) ({flow:.3g}): transient growth of a matrix that is not "
        "normal, which no step would avoid."
    )
    return statement(
        f"L-C12.criterion.{scheme}",
        faithful and above > _GROWN,
        f"RK1 and RK2 on {size} particles: at {_BELOW:g} of the limit the norm of n steps is at most {below:.3g} for n "
        f"up to 2^{_SQUARINGS} and no longer grows; at {_ABOVE:g} of it 1024 steps reach {above:.1e}."
        f"{remark if below > 1.0 + _SATURATED else ''}",
        "The powers of a step do not change from bounded to growing where (54) says.",
    )


def _trends(betas: list[float]) -> list[Finding]:
    fine = [beta for beta in _BETAS if betas[0] <= beta <= betas[-1]]
    findings = []
    for scheme, claim, sign in (("DD", "rises", 1), ("FPSE", "rises", 1), ("KPSE", "falls", -1)):
        a = np.array([stability_limit(scheme, beta) for beta in fine])
        findings.append(
            statement(
                f"L-C13.{scheme}_{claim}",
                (sign * np.diff(a) > 0.0).all(),
                f"From {a[0]:.4f} at beta = {fine[0]:g} to {a[-1]:.4f} at {fine[-1]:g}, steadily over "
                f"{len(fine)} values of beta.",
                "The limit does not change in one direction.",
            )
        )
    return findings


def _series(betas: list[float], printed: Mapping[str, str]) -> pd.DataFrame:
    """Panel "limit": a against beta; panel "symbol": -A(theta) h^alpha / D at the middle beta."""
    middle = betas[len(betas) // 2]
    theta = np.linspace(0.0, np.pi, 181)
    curves: list[tuple] = []
    for scheme in _SCHEMES:
        for order, name in ORDERS.items():
            setting = Setting(alpha=1.0 + middle, order=order, overlap=_OVERLAP)
            limit = [stability_limit(scheme, beta, order) for beta in _BETAS]
            curves.append(("limit", scheme, name, _BETAS, limit))
            curves.append(("symbol", scheme, name, theta, -SCHEMES[scheme].symbol(theta, setting)))
        texts = {b: printed.get(f"L-T3.{scheme}.beta{b:g}") for b in betas}
        known = {b: float(text) for b, text in texts.items() if text}
        curves.append(("printed", scheme, "II", list(known), list(known.values())))
    curves.append(("symbol", "exact", "", theta, theta ** (1.0 + middle)))
    names = ("panel", "scheme", "order", "x", "y")
    frames = [pd.DataFrame(dict(zip(names, curve, strict=True))) for curve in curves]
    return pd.concat([frame for frame in frames if len(frame)], ignore_index=True)
