"""Table 3: the stability limit, the spectrum behind it, and whether (54) is the criterion."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.linalg import expm

from fracparticles.lattice.dense import Spectrum, norms_of_powers, spectrum
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import power_iteration, scheme_matrix
from fracparticles.schemes.stability import stability_limit
from fracparticles.time import STEP_POLYNOMIALS
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.panels import Panels
from fracstudy.verdicts import judge_value

_SCHEMES = ("DD", "FPSE", "KPSE")
_STEPS = {"euler": "RK1", "rk2": "RK2"}
_OVERLAP = 2.0
_ROUND_OFF = 1e-12  # relative to |lambda_min|: N roundings of the matrix's entries
_BELOW, _ABOVE = 0.99, 1.01  # steps on either side of the limit (54)
# Norms of powers: n = 2^0, 2^4, .. 2^36 below the limit, n = 2^10 above. The roundings of 36 squarings
# add up to 2^36 1e-16, 1e-5 in all.
_SQUARINGS, _EVERY, _FEW_SQUARINGS = 36, 4, 10
# The values of beta of the curves.
_BETAS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)


def _matrix(scheme: str, alpha: float, order: int, particles: int) -> np.ndarray:
    setting = Setting(n=particles // 2, spacing=1.0, alpha=alpha, order=order, overlap=_OVERLAP)
    return scheme_matrix(scheme, setting)


class _Growth(NamedTuple):
    below: float  # greatest norm of p(A dt)^n below the limit
    flow: float  # greatest norm of exp(n dt A), the same times
    late: float  # change of the norm from n = 2^32 to 2^36, over the greatest
    above: float  # norm of p(A dt)^1024 above the limit
    asymmetry: float  # |P - P^T| / |P|, P = p(A dt) below the limit


def _growths(a: np.ndarray, lowest: float) -> dict[str, _Growth]:
    """Norms of the powers of one step just below and just above dt = 2 / |lambda_min|, Eq. (54)."""
    below, above = (share * 2.0 / abs(lowest) * a for share in (_BELOW, _ABOVE))
    flow = max(norms_of_powers(expm(below), _SQUARINGS, _EVERY))
    growths = {}
    for integrator in _STEPS:
        p = _step(below, integrator)
        norms = norms_of_powers(p, _SQUARINGS, _EVERY)
        last = norms_of_powers(_step(above, integrator), _FEW_SQUARINGS, _FEW_SQUARINGS)[-1]
        late = (norms[-1] - norms[-2]) / max(norms)
        asymmetry = np.linalg.norm(p - p.T) / np.linalg.norm(p)
        growths[integrator] = _Growth(max(norms), flow, late, last, float(asymmetry))
    return growths


def _step(z: np.ndarray, integrator: str) -> np.ndarray:
    """p(z), z = A dt, Eq. (52)."""
    one = np.eye(len(z))
    return one + z if integrator == "euler" else one + z + 0.5 * z @ z


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
    rows = [_row(*of, s[-1], iterated.get(of[:2]), inputs.printed) for of, s in spectra.items()]
    limits = each(stability_limit, scheme=_SCHEMES, beta=beta)
    growths = {
        (s, b): _growths(_matrix(s, 1.0 + b, 2, size), spectra[s, b, 2][-2].lowest)
        for s, b in limits.index
    }
    findings = [
        *(
            measured(f"L-T3.{s}.beta{b:g}", ours=a, **iterated[s, b]._asdict())
            for (s, b), a in limits.items()
        ),
        *_limits(limits, spacing[0]),
        *_matrices(spectra, beta),
        *_criterion(growths, size),
        *_trends(beta),
    ]
    return Result(pd.DataFrame(rows), findings, _series(beta, inputs.printed))


class _Iterated(NamedTuple):
    power: float  # a by power iteration
    iterations: int


def _iterate(scheme: str, beta: float, h: float, truncation: float, tolerance: float) -> _Iterated:
    given = {"scheme": scheme, "beta": beta, "truncation": truncation, "spacing": h}
    setting = Case(**given, integrator="exponential").setting
    operator = SCHEMES[scheme].operator(setting)
    eigenvalue, iterations = power_iteration(operator, tolerance=tolerance)
    return _Iterated(-2.0 * setting.rate / eigenvalue, iterations)


def _row(
    scheme: str,
    beta: float,
    order: int,
    dense: Spectrum,
    iterated: _Iterated | None,
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
        "power iteration": paper.power if paper else np.nan,
        f"eigenvalues, N = {dense.particles}": -2.0 / dense.lowest,
        "deviation": limit / theirs - 1.0,
        "status": f"{status.sign} {status}" if status else "",
        "RK4": 0.5 * STEP_POLYNOMIALS["rk4"].stability_interval * limit,
        "largest / least eigenvalue": ratio if abs(ratio) > _ROUND_OFF else 0.0,
        "asymmetry": dense.asymmetry if dense.asymmetry > _ROUND_OFF else 0.0,
    }


def _limits(limits: pd.Series, h: float) -> Iterator[Finding]:
    """What Secs. 4.4 and 6 say of the limits, by scheme and by beta; of the steps themselves at one h."""
    dd, fpse, kpse = (limits[s] for s in _SCHEMES)

    def spread(a: pd.Series) -> dict[str, float]:
        return {s: np.ptp(a[s]) / a[s].min() for s in _SCHEMES}

    over_kpse = fpse / kpse
    ratios = {"KPSE": over_kpse.min(), "DD": (fpse / dd).min()}
    steps = spread(limits * h ** (1.0 + limits.index.get_level_values("beta")))
    yield measured("L-T3.ordering", dd_over_kpse=dd / kpse, fpse_over_dd=fpse / dd)
    yield measured("L-T3.several_times", ratio=ratios)
    yield measured("L-T3.weak_in_beta", spread=spread(limits))
    yield measured("L-T3.comparable", ratio=over_kpse)
    yield measured("L-T3.conclusion_comparable", ratio=over_kpse)
    others = {f"the step itself at h = {h:.3g}": {"spread": steps}}
    yield measured("L-T3.conclusion_weak", others=others, spread=spread(limits), steps=steps)


def _matrices(
    spectra: Mapping[tuple[str, float, int], Sequence[Spectrum]], betas: Sequence[float]
) -> Iterator[Finding]:
    """What Sec. 4.4 says of A, order II, the worst over beta."""

    def worst(scheme: str, quantity: Callable[[Spectrum], float], k: int = -1) -> float:
        return max(quantity(spectra[scheme, b, 2][k]) for b in betas)

    sizes = [s.particles for s in spectra["DD", betas[0], 2]]
    for scheme in _SCHEMES:
        by_size = [worst(scheme, lambda s: s.asymmetry, k) for k in range(len(sizes))]
        yield measured(
            f"L-C12.symmetric.{scheme}",
            asymmetry=by_size[-1],
            by_size={f"N = {n}": m for n, m in zip(sizes, by_size, strict=True)},
            departure=worst(scheme, lambda s: s.departure),
        )
    largest = {key: of[-1].highest / abs(of[-1].lowest) for key, of in spectra.items()}
    every = {
        f"{s} {name}": max(m for (t, _, p), m in largest.items() if (t, p) == (s, order))
        for s, (order, name) in product(_SCHEMES, ORDERS.items())
    }
    highest = {s: every[f"{s} II"] for s in _SCHEMES}
    imaginary = worst("FPSE", lambda s: s.imaginary / abs(s.lowest))
    yield measured("L-C12.nonpositive", highest=every, particles=sizes[-1])
    for scheme in ("FPSE", "KPSE"):
        yield measured(f"L-C12.max_zero.{scheme}", highest=abs(highest[scheme]))
    yield measured("L-C12.real.FPSE", imaginary=imaginary, particles=sizes[-1])
    yield measured("L-C12.max_negative.DD", highest=highest["DD"], particles=sizes[-1])


def _criterion(
    growths: Mapping[tuple[str, float], Mapping[str, _Growth]], size: int
) -> Iterator[Finding]:
    """Steps of RK1 and RK2 just below and just above (54): bounded by the exact flow, and growing."""

    def numbers(parts: Sequence[_Growth]) -> dict[str, Any]:
        return {
            "growth": max(g.late for g in parts),
            "excess": max(g.below / g.flow - 1.0 for g in parts),
            "below": max(g.below for g in parts),
            "above": min(g.above for g in parts),
        }

    above, asymmetry = {}, {}
    for scheme in _SCHEMES:
        parts = [g for (s, _), one in growths.items() if s == scheme for g in one.values()]
        yield measured(f"L-C12.criterion.{scheme}", particles=size, **numbers(parts))
        above[scheme] = min(g.above for g in parts)
        asymmetry[scheme] = max(g.asymmetry for g in parts)
    yield measured("L-C12.constraint", above=above, particles=size)
    yield measured("L-C12.polynomial", asymmetry=asymmetry)
    by_name = {name: [one[i] for one in growths.values()] for i, name in _STEPS.items()}
    yield measured(
        "L-T3.rk1_rk2",
        particles=size,
        growth={name: numbers(parts)["growth"] for name, parts in by_name.items()},
        above={name: numbers(parts)["above"] for name, parts in by_name.items()},
    )


def _trends(betas: Sequence[float]) -> Iterator[Finding]:
    """The smallest step of a from one beta to the next, in the direction that Sec. 4.4 says."""
    fine = [beta for beta in _BETAS if betas[0] <= beta <= betas[-1]]
    for scheme, claim, sign in (("DD", "rises", 1), ("FPSE", "rises", 1), ("KPSE", "falls", -1)):
        a = np.array([stability_limit(scheme, beta) for beta in fine])
        ends = {"first": a[0], "last": a[-1]}
        least = (sign * np.diff(a)).min()
        yield measured(f"L-C13.{scheme}_{claim}", step=least, **ends, count=len(fine))


def _series(betas: list[float], printed: Mapping[str, str]) -> pd.DataFrame:
    """Panel "limit": a against beta; panel "symbol": -A(theta) h^alpha / D at the middle beta."""
    middle, panels = betas[len(betas) // 2], Panels()
    theta = np.linspace(0.0, np.pi, 181)
    for scheme in _SCHEMES:
        for order, name in ORDERS.items():
            setting = Setting(alpha=1.0 + middle, order=order, overlap=_OVERLAP)
            limit = [stability_limit(scheme, beta, order) for beta in _BETAS]
            panels.add("limit", scheme=scheme, order=name, x=_BETAS, y=limit)
            symbol = -SCHEMES[scheme].symbol(theta, setting)
            panels.add("symbol", scheme=scheme, order=name, x=theta, y=symbol)
        texts = {b: printed.get(f"L-T3.{scheme}.beta{b:g}") for b in betas}
        for b, text in texts.items():
            if text:
                panels.add("printed", scheme=scheme, order="II", x=b, y=float(text))
    panels.add("symbol", scheme="exact", order="", x=theta, y=theta ** (1.0 + middle))
    return panels.frame
