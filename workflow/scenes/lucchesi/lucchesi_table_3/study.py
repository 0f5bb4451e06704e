"""Table 3: the stability limit, the spectrum behind it, and whether (54) is the criterion."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.linalg import expm

from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix, power_iteration
from fracparticles.schemes.stability import closed_form_limit, stability_limit
from fracparticles.time import STEP_POLYNOMIALS
from fracstudy.claims import Finding, judge_value, unit_of_last_digit
from fracstudy.inputs import ORDERS, Inputs, Result, statement, value

__all__ = ["Spectrum", "spectrum", "study", "truncated_print"]

_SCHEMES = ("DD", "FPSE", "KPSE")
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


class Spectrum(NamedTuple):
    """The matrix A h^alpha / D of N particles: what Sec. 4.4 says of it.

    Attributes
    ----------
    particles : int
    lowest, highest : float
        Least and greatest real part of its eigenvalues.
    imaginary : float
        Greatest imaginary part.
    asymmetry : float
        |A - A^T| / |A|, Frobenius norms.
    departure : float
        |A A^T - A^T A| / |A|^2, the departure from normality.
    """

    particles: int
    lowest: float
    highest: float
    imaginary: float
    asymmetry: float
    departure: float


def _matrix(scheme: str, alpha: float, order: int, particles: int) -> np.ndarray:
    setting = Setting(n=particles // 2, spacing=1.0, alpha=alpha, order=order, overlap=_OVERLAP)
    return dense_matrix(SCHEMES[scheme].operator(setting))


def spectrum(scheme: str, alpha: float, order: int, particles: int) -> Spectrum:
    """Return the `Spectrum` of a scheme on N particles, all eigenvalues computed."""
    a = _matrix(scheme, alpha, order, particles)
    eigenvalues = np.linalg.eigvals(a)
    size = np.linalg.norm(a)
    return Spectrum(
        particles,
        float(eigenvalues.real.min()),
        float(eigenvalues.real.max()),
        float(np.abs(eigenvalues.imag).max()),
        float(np.linalg.norm(a - a.T) / size),
        float(np.linalg.norm(a @ a.T - a.T @ a) / size**2),
    )


class _Growth(NamedTuple):
    below: float  # greatest norm of p(A dt)^n below the limit
    flow: float  # greatest norm of exp(n dt A), the same times
    saturated: bool  # whether the norm stops growing
    above: float  # norm of p(A dt)^1024 above the limit


def _growths(a: np.ndarray, lowest: float) -> dict[str, _Growth]:
    """Norms of the powers of one step just below and just above dt = 2 / |lambda_min|, Eq. (54)."""
    limit = 2.0 / abs(lowest)
    flow = max(_norms(expm(_BELOW * limit * a), _SQUARINGS, _EVERY))
    growths = {}
    for integrator in ("euler", "rk2"):
        below = _norms(_step(a, _BELOW * limit, integrator), _SQUARINGS, _EVERY)
        above = _norms(_step(a, _ABOVE * limit, integrator), _FEW_SQUARINGS, _FEW_SQUARINGS)
        saturated = below[-1] <= (1.0 + _SATURATED) * below[-2]
        growths[integrator] = _Growth(max(below), flow, saturated, above[-1])
    return growths


def _step(a: np.ndarray, dt: float, integrator: str) -> np.ndarray:
    """p(A dt), Eq. (52)."""
    one = np.eye(len(a))
    z = a * dt
    return one + z if STEP_POLYNOMIALS[integrator].stages == 1 else one + z + 0.5 * z @ z


def _norms(step: np.ndarray, squarings: int, every: int) -> list[float]:
    norms = []
    for k in range(squarings + 1):
        if k % every == 0:
            norms.append(float(np.linalg.norm(step, 2)))
        step = step @ step
    return norms


def truncated_print(printed: str, ours: float) -> bool:
    """Return whether the print holds our digits cut off where rounding would have changed the last one."""
    unit = unit_of_last_digit(printed)
    cut = Fraction(ours) // unit * unit
    return cut == Fraction(printed) and Fraction(ours) - cut > unit / 2


def study(inputs: Inputs) -> Result:
    """Give the limit a of (55) four ways, and judge what Sec. 4.4 says of the matrix A.

    - from the symbol, on the infinite lattice, and in closed form with the aliases neglected;
    - by power iteration on the paper's lattice, and from all eigenvalues of a small one.

    Parameters of the scene: `beta`, with the `spacing` of the paper for each; `truncation`; the `tolerance` of the
    power iteration; `dense`, the numbers of particles of the small lattices, at least two.
    """
    parameters = inputs.parameters
    betas = [float(beta) for beta in parameters["beta"]]
    sizes = sorted(int(size) for size in parameters["dense"])
    printed = inputs.printed
    spectra = {
        (scheme, beta, order): [spectrum(scheme, 1.0 + beta, order, size) for size in sizes]
        for beta in betas
        for scheme in (*_SCHEMES, "GPSE")
        for order in ORDERS
        if order in SCHEMES[scheme].ORDERS
    }
    iterated = {
        (scheme, beta): _iterate(scheme, beta, float(h), parameters)
        for beta, h in zip(betas, parameters["spacing"], strict=True)
        for scheme in _SCHEMES
    }
    table = pd.DataFrame(
        _row(scheme, beta, order, spectra[scheme, beta, order][-1], iterated, printed)
        for scheme, beta, order in spectra
    )
    limits = {(s, b): stability_limit(s, b) for s in _SCHEMES for b in betas}
    growths = {
        (scheme, beta, integrator): growth
        for scheme in _SCHEMES
        for beta in betas
        for integrator, growth in _growths(
            _matrix(scheme, 1.0 + beta, 2, sizes[-2]), spectra[scheme, beta, 2][-2].lowest
        ).items()
    }
    findings = [
        *(_print(s, b, a, iterated[s, b], printed) for (s, b), a in limits.items()),
        *_words(limits, betas),
        _same_step(growths, sizes[-2]),
        *_matrices(spectra, betas),
        *(_criterion(scheme, growths, sizes[-2]) for scheme in _SCHEMES),
        *_trends(betas),
    ]
    return Result(table, findings, _series(betas, printed))


def _iterate(
    scheme: str, beta: float, h: float, parameters: Mapping[str, Any]
) -> tuple[float, int]:
    """a by power iteration, and the number of iterations."""
    case = Case(
        scheme=scheme,
        beta=beta,
        truncation=float(parameters["truncation"]),
        spacing=h,
        integrator="exponential",
    )
    operator = SCHEMES[scheme].operator(case.setting)
    eigenvalue, iterations = power_iteration(operator, tolerance=float(parameters["tolerance"]))
    return -2.0 * case.setting.rate / eigenvalue, iterations


def _size(value: float) -> str:
    """A ratio in words: the last digits of round-off are nobody's result."""
    return f"{value:.1e}" if abs(value) > _ROUND_OFF else f"less than {_ROUND_OFF:g}"


def _row(
    scheme: str,
    beta: float,
    order: int,
    dense: Spectrum,
    iterated: dict[tuple[str, float], tuple[float, int]],
    printed: Mapping[str, str],
) -> dict[str, object]:
    limit = stability_limit(scheme, beta, order)
    text = printed.get(f"L-T3.{scheme}.beta{beta:g}") if order == 2 else None
    paper = order == 2 and scheme in _SCHEMES
    status = judge_value(text, limit) if text else None
    half = 0.5 * STEP_POLYNOMIALS["rk4"].stability_interval
    return {
        "beta": beta,
        "scheme": scheme,
        "order": ORDERS[order],
        "printed": float(text) if text else np.nan,
        "symbol": limit,
        "closed form": closed_form_limit(scheme, beta) if paper else np.nan,
        "power iteration": iterated[scheme, beta][0] if paper else np.nan,
        f"eigenvalues, N = {dense.particles}": -2.0 / dense.lowest,
        "deviation": limit / float(text) - 1.0 if text else np.nan,
        "status": f"{status.sign} {status}" if status else "",
        "RK4": half * limit,
        "largest / least eigenvalue": _relative(dense),
        "asymmetry": dense.asymmetry if dense.asymmetry > _ROUND_OFF else 0.0,
    }


def _relative(dense: Spectrum) -> float:
    ratio = dense.highest / abs(dense.lowest)
    return ratio if abs(ratio) > _ROUND_OFF else 0.0


def _print(
    scheme: str, beta: float, limit: float, iterated: tuple[float, int], printed: Mapping[str, str]
) -> Finding:
    name = f"L-T3.{scheme}.beta{beta:g}"
    reason = ""
    if name in printed and truncated_print(printed[name], limit):
        reason = (
            f"Printed truncated, not rounded: the symbol gives {limit:.4f}, and power iteration comes down to it "
            f"from above ({iterated[0]:.4f} after {iterated[1]} iterations)."
        )
    return value(name, limit, reason)


def _words(limits: dict[tuple[str, float], float], betas: list[float]) -> list[Finding]:
    dd, fpse, kpse = (np.array([limits[s, b] for b in betas]) for s in _SCHEMES)
    over_dd, over_kpse = fpse / dd, fpse / kpse
    spread = {s: max(a) / min(a) - 1.0 for s, a in zip(_SCHEMES, (dd, fpse, kpse), strict=True)}
    widest = max(spread, key=spread.__getitem__)
    spans = f"from beta = {betas[0]:g} to {betas[-1]:g}"
    return [
        statement(
            "L-T3.ordering",
            bool((kpse < dd).all() and (dd < fpse).all()),
            f"KPSE {_list(kpse)}, DD {_list(dd)}, FPSE {_list(fpse)} at beta = {_list(betas, 'g')}.",
            "The limits are in another order at some beta.",
        ),
        statement(
            "L-T3.several_times",
            bool(over_dd.min() > _SEVERAL and over_kpse.min() > _SEVERAL),
            f"FPSE's limit is {_list(over_kpse)} times that of KPSE, but {_list(over_dd)} times that of DD, at beta = "
            f"{_list(betas, 'g')}; several is taken as more than {_SEVERAL:g}.",
            "Of KPSE it is true, of DD not: in closed form the ratio to DD is 2^(alpha/2), less than 2.",
        ),
        statement(
            "L-T3.weak_in_beta",
            bool(max(spread.values()) < _SIGNIFICANT),
            f"The limit varies by {', '.join(f'{100 * v:.0f} % ({s})' for s, v in spread.items())} {spans}; "
            f"significant "
            f"is taken as more than {100 * _SIGNIFICANT:.0f} %.",
            f"True of the others, not of {widest}: its limit varies by {100 * spread[widest]:.0f} % {spans}.",
        ),
        statement(
            "L-T3.comparable",
            bool((fpse / kpse).max() < _COMPARABLE),
            f"The largest limit is {_list(fpse / kpse)} times the smallest at beta = {_list(betas, 'g')}; "
            f"comparable is "
            f"taken as within a factor of {_COMPARABLE:g}.",
            "The limits differ by more than an order of magnitude.",
        ),
    ]


def _same_step(growths: dict[tuple[str, float, str], _Growth], size: int) -> Finding:
    bounded = {
        i: max(g.below for (_, _, k), g in growths.items() if k == i) for i in ("euler", "rk2")
    }
    grown = {
        i: min(g.above for (_, _, k), g in growths.items() if k == i) for i in ("euler", "rk2")
    }
    stable = all(g.saturated for g in growths.values())
    return statement(
        "L-T3.rk1_rk2",
        stable and min(grown.values()) > _GROWN,
        f"With all three schemes on {size} particles, the powers of a step at {_BELOW:g} of 2/|lambda_min| stay "
        f"bounded "
        f"(RK1 {bounded['euler']:.3g}, RK2 {bounded['rk2']:.3g}), and 1024 steps at {_ABOVE:g} of it grow by at least "
        f"{grown['euler']:.1e} (RK1) and {grown['rk2']:.1e} (RK2).",
        "RK1 and RK2 lose stability at different steps.",
    )


def _matrices(
    spectra: dict[tuple[str, float, int], list[Spectrum]], betas: list[float]
) -> list[Finding]:
    def worst(scheme: str, quantity: Callable[[Spectrum], float]) -> float:
        return max(quantity(spectra[scheme, beta, 2][-1]) for beta in betas)

    size = spectra["DD", betas[0], 2][-1].particles
    findings = []
    for scheme in _SCHEMES:
        asymmetry = worst(scheme, lambda s: s.asymmetry)
        sizes = (
            _size(asymmetry)
            if asymmetry <= _ROUND_OFF
            else ", ".join(
                f"{max(spectra[scheme, b, 2][k].asymmetry for b in betas):.2f} (N = {s.particles})"
                for k, s in enumerate(spectra[scheme, betas[0], 2])
            )
        )
        departure = worst(scheme, lambda s: s.departure)
        findings.append(
            statement(
                f"L-C12.symmetric.{scheme}",
                asymmetry <= _ROUND_OFF,
                f"|A - A^T| / |A| is {sizes}, the largest over beta; |A A^T - A^T A| / |A|^2 is "
                f"{_size(departure)} at N = {size}.",
                "A is the product of two sums that do not commute where the lattice ends: the asymmetry falls like "
                "N^(-1/2), as that of a number of rows that does not grow with N.",
            )
        )
    imaginary = worst("FPSE", lambda s: s.imaginary / abs(s.lowest))
    findings.append(
        statement(
            "L-C12.real.FPSE",
            imaginary <= _ROUND_OFF,
            f"The imaginary parts are {_size(imaginary)} times |lambda_min| at N = {size}, although A is not "
            f"symmetric.",
            "Some eigenvalues are complex.",
        )
    )
    for scheme in ("FPSE", "KPSE"):
        highest = worst(scheme, lambda s: abs(s.highest / s.lowest))
        findings.append(
            statement(
                f"L-C12.max_zero.{scheme}",
                highest <= _ROUND_OFF,
                f"The largest eigenvalue is {_size(highest)} times |lambda_min| in modulus at N = {size}.",
                "The largest eigenvalue is not 0.",
            )
        )
    highest = worst("DD", lambda s: s.highest / abs(s.lowest))
    findings.append(
        statement(
            "L-C12.max_negative.DD",
            highest < -_ROUND_OFF,
            f"The largest eigenvalue is {highest:.1e} |lambda_min| at N = {size}.",
            "The largest eigenvalue of DD is not negative.",
        )
    )
    return findings


def _criterion(scheme: str, growths: dict[tuple[str, float, str], _Growth], size: int) -> Finding:
    mine = [g for (s, _, _), g in growths.items() if s == scheme]
    below, flow, above = (
        max(g.below for g in mine),
        max(g.flow for g in mine),
        min(g.above for g in mine),
    )
    # Bounded, and by no more than the exact flow itself.
    faithful = all(g.saturated and g.below <= (1.0 + _SATURATED) * g.flow for g in mine)
    remark = ""
    if below > 1.0 + _SATURATED:
        remark = (
            f" The norm is that of the exact flow exp(t A) ({flow:.3g}): transient growth of a matrix that is not "
            "normal, which no step would avoid."
        )
    return statement(
        f"L-C12.criterion.{scheme}",
        faithful and above > _GROWN,
        f"RK1 and RK2 on {size} particles: at {_BELOW:g} of the limit the norm of n steps is at most {below:.3g} for n "
        f"up to 2^{_SQUARINGS} and no longer grows; at {_ABOVE:g} of it 1024 steps reach {above:.1e}.{remark}",
        "The powers of a step do not change from bounded to growing where (54) says.",
    )


def _trends(betas: list[float]) -> list[Finding]:
    fine = [beta for beta in _BETAS if betas[0] <= beta <= betas[-1]]
    findings = []
    for scheme, claim, sign in (
        ("DD", "DD_rises", 1),
        ("FPSE", "FPSE_rises", 1),
        ("KPSE", "KPSE_falls", -1),
    ):
        a = np.array([stability_limit(scheme, beta) for beta in fine])
        findings.append(
            statement(
                f"L-C13.{claim}",
                bool((sign * np.diff(a) > 0.0).all()),
                f"From {a[0]:.4f} at beta = {fine[0]:g} to {a[-1]:.4f} at {fine[-1]:g}, steadily over "
                f"{len(fine)} values of beta.",
                "The limit does not change in one direction.",
            )
        )
    return findings


def _series(betas: list[float], printed: Mapping[str, str]) -> pd.DataFrame:
    """Panel "limit": a against beta; panel "symbol": -A(theta) h^alpha / D at the middle beta."""
    rows = []
    middle = betas[len(betas) // 2]
    theta = np.linspace(0.0, np.pi, 181)
    for scheme in _SCHEMES:
        for order in ORDERS:
            key = {"scheme": scheme, "order": ORDERS[order]}
            rows += [
                {"panel": "limit", **key, "x": beta, "y": stability_limit(scheme, beta, order)}
                for beta in _BETAS
            ]
            symbol = -SCHEMES[scheme].symbol(theta, 1.0 + middle, order, _OVERLAP)
            rows += [
                {"panel": "symbol", **key, "x": x, "y": y}
                for x, y in zip(theta, symbol, strict=True)
            ]
        rows += [
            {
                "panel": "printed",
                "scheme": scheme,
                "order": "II",
                "x": beta,
                "y": float(printed[name]),
            }
            for beta in betas
            if (name := f"L-T3.{scheme}.beta{beta:g}") in printed
        ]
    rows += [
        {"panel": "symbol", "scheme": "exact", "order": "", "x": x, "y": x ** (1.0 + middle)}
        for x in theta
    ]
    return pd.DataFrame(rows)


def _list(values: Iterable[float], form: str = ".2f") -> str:
    return ", ".join(f"{v:{form}}" for v in values)
