"""Stiff and extreme cases: what the schemes and the integrators do there, against what they must do."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from itertools import product
from math import ceil
from typing import Any

import numpy as np
import pandas as pd
from scipy.linalg import expm

from fracparticles import time as integrators
from fracparticles.errors import AccuracyWarning, NonFiniteSolution, StabilityWarning
from fracparticles.kernels.families import kernel
from fracparticles.run.case import Case
from fracparticles.run.solution import Solution, relative_l1_error
from fracparticles.run.solver import compute, initial_strengths
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.schemes.stability import symbol_range
from fracparticles.special.stable import green
from fracstudy.inputs import Inputs, Result

__all__ = ["study"]

_SCHEMES = ("DD", "FPSE", "KPSE")
_STEPS = 600  # of a growth measurement: 1.5^600 does not overflow yet
_RK2 = integrators.STEP_POLYNOMIALS["rk2"]
# The round-off of a run adds up over some thousand operations on quantities of the size of the largest strength.
_SAME = 1e-10

Base = dict[str, float]
# Case, what is expected, what was found, whether they agree; the verdict if they do, unless it is OK.
Check = tuple[Any, ...]
OK, BLOWS_UP, UNEXPECTED = "ok", "blows up as predicted", "not as expected"


def study(
    inputs: Inputs, *, beta: float, half_width: float, spacing: float, factors: list[float]
) -> Result:
    """One row a check: the case, what is expected, what was found, and whether they agree.

    The growth factor of RK2 per step, from random strengths, is held against the spectral radius of p(A dt) of (52)
    around the limit (54), for steps of `factors` times it; the operator applications that RK2 needs at its limit are
    held against those of the series.
    """
    base = {"beta": beta, "half_width": half_width, "spacing": spacing}
    growth = _growth(base, factors)
    checks = {"stability limit": _growth_checks(growth)}
    checks |= {what: of(base) for what, of in _CHECKS.items()}
    rows = [
        {"what": what, "case": case, "expected": expected, "found": found, "verdict": verdict}
        for what, results in checks.items()
        for case, expected, found, agrees, *rest in results
        for verdict in ([*rest, OK] if agrees else [UNEXPECTED])[:1]
    ]
    series = pd.concat([growth, _work(beta)], ignore_index=True)
    return Result(pd.DataFrame(rows), (), series)


def _same(case: str, expected: str, u: np.ndarray, v: np.ndarray, of: str = "peak") -> Check:
    """The check that u is v to round-off."""
    difference = _largest_difference(u, v)
    found = f"largest difference {difference:.1e} of the {of}"
    return case, expected, found, difference < _SAME


def _falls_four_times(case: str, expected: str, errors: list[float]) -> Check:
    """The check of second order, for h halved."""
    ratio = errors[0] / errors[1]
    found = f"{errors[0]:.2e} to {errors[1]:.2e}, {ratio:.2f} times"
    return case, expected, found, abs(ratio - 4.0) < 0.4


def _run(initial: Any = None, **fields: Any) -> Solution:
    """Compute a case whose step may be unstable, and whose data rough, on purpose."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StabilityWarning)
        warnings.simplefilter("ignore", AccuracyWarning)
        return compute(Case(store="metrics", **fields), initial)


def _limit(scheme: str, **fields: Any) -> float:
    return Case(scheme=scheme, dt=1e-6, **fields).largest_stable_step


def _matrix(setting: Setting, scheme: str) -> np.ndarray:
    return dense_matrix(SCHEMES[scheme].operator(setting))


def _largest_difference(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).max() / np.abs(b).max())


# --- at the stability limit -------------------------------------------------------------------------------------------


def _growth(base: Base, factors: list[float]) -> pd.DataFrame:
    """The measured growth factor of the last fifty of 600 steps, and the spectral radius of p(A dt)."""
    rows = []
    for scheme in _SCHEMES:
        case = Case(scheme=scheme, dt=1e-6, **base)
        operator = SCHEMES[scheme].operator(case.setting)
        eigenvalues = np.linalg.eigvals(dense_matrix(operator))
        start = np.random.default_rng(0).standard_normal(operator.size)
        for factor in factors:
            dt = factor * case.largest_stable_step
            u = integrators.step(operator, _RK2, dt, _STEPS - 50, start)
            v = integrators.step(operator, _RK2, dt, 50, u)
            measured = (np.linalg.norm(v) / np.linalg.norm(u)) ** (1.0 / 50.0)
            predicted = np.abs(_polynomial(eigenvalues * dt)).max()
            rows.append((scheme, factor, measured, predicted))
    return pd.DataFrame(rows, columns=["series", "x", "y", "predicted"]).assign(panel="growth")


def _growth_checks(growth: pd.DataFrame) -> Iterator[Check]:
    for scheme, part in growth.groupby("series"):
        for side, here in (("below", part[part["x"] < 1.0]), ("above", part[part["x"] > 1.0])):
            deviation = (here["y"] - here["predicted"]).abs().max()
            yield (
                f"{scheme}, RK2, dt = {here['x'].min():g} to {here['x'].max():g} of the limit",
                f"growth per step {here['predicted'].min():.4f} to {here['predicted'].max():.4f}",
                f"{here['y'].min():.4f} to {here['y'].max():.4f}",
                # The slow modes decay like 1 / n, so that 50 of 600 steps tell the factor to a few 1e-3.
                deviation < 5e-3,
                OK if side == "below" else BLOWS_UP,
            )


def _overflow(base: Base) -> Iterator[Check]:
    """1.2 times the limit: the step of overflow from the modes of A, stepping and series."""
    for scheme in _SCHEMES:
        dt = 1.2 * _limit(scheme, **base)
        fields = {**base, "scheme": scheme, "dt": dt, "t_final": 0.5 + dt * 4000}
        case = Case(evaluation="stepping", **fields)
        values, modes = np.linalg.eig(_matrix(case.setting, scheme))
        coefficients = np.linalg.solve(modes, initial_strengths(case)[0])
        amplitude = np.abs(coefficients) * np.abs(modes).max(axis=0)
        factor = np.log(np.abs(_polynomial(values * case.time_step)))
        room = np.log(np.finfo(float).max) - np.log(np.maximum(amplitude, np.finfo(float).tiny))
        growing = factor > 0.0
        step = float((room[growing] / factor[growing]).min())
        stepping, series = (_message(evaluation=e, **fields) for e in ("stepping", "series"))
        found = int(stepping.split("after step ")[1].split()[0]) if stepping else 0
        yield (
            f"{scheme}, RK2, dt = 1.2 of the limit",
            f"NonFiniteSolution near step {step:.0f}, from stepping and from the series",
            f"after step {found} ({'raised' if series else 'not raised'} by the series)",
            abs(found - step) < 0.05 * step and bool(series),
            BLOWS_UP,
        )


def _polynomial(z: np.ndarray) -> np.ndarray:
    return 1.0 + z + 0.5 * z**2


def _message(**fields: Any) -> str:
    try:
        _run(**fields)
    except NonFiniteSolution as error:
        return str(error)
    return ""


def _edge_of_stability(base: Base) -> Iterator[Check]:
    """RK1, RK2 and RK4 at 0.999 of their limit: the Chebyshev series is the same polynomial."""
    for scheme, method in product(_SCHEMES, ("euler", "rk2", "rk4")):
        fields = {**base, "integrator": method, "t_final": 20.5}
        dt = 0.999 * _limit(scheme, **fields)
        stepped, series = (
            _run(scheme=scheme, evaluation=e, dt=dt, **fields) for e in ("stepping", "series")
        )
        case = f"{scheme}, {method}, dt = 0.999 of the limit, {stepped.case.steps} steps"
        expected = "the same discrete solution"
        yield _same(case, expected, series.u, stepped.u)


# --- extreme parameters -----------------------------------------------------------------------------------------------


def _extreme_orders(base: Base) -> Iterator[Check]:
    """Second order in h survives next to beta = 0 and beta = 1."""
    fields = {"half_width": 60.0, "integrator": "exponential", "exterior": "open"}
    for beta, scheme in product((0.01, 0.99), _SCHEMES):
        runs = [_run(scheme=scheme, beta=beta, spacing=h, **fields) for h in (0.1, 0.05)]
        case = f"{scheme}, beta = {beta:g}, open exterior, h = 0.1 and 0.05"
        errors = [relative_l1_error(run.case, run.u) for run in runs]
        yield _falls_four_times(case, "error (48) falls 4 times", errors)


def _small_overlap(base: Base) -> Iterator[Check]:
    """Overlap 1/2: for order IV the symbol of FPSE is positive, so that it grows however small the step."""
    alpha, h = 1.0 + base["beta"], base["spacing"]
    lattice: dict[str, Any] = {
        "n": round(base["half_width"] / h),
        "spacing": h,
        "alpha": alpha,
        "overlap": 0.5,
    }
    for scheme, order in (("FPSE", 2), ("FPSE", 4), ("KPSE", 2)):
        setting = Setting(order=order, **lattice)
        matrix = _matrix(setting, scheme) / setting.rate
        greatest = float(np.linalg.eigvals(matrix).real.max())
        predicted = symbol_range(scheme, base["beta"], order, 0.5)[1]
        yield (
            f"{scheme}, order {order}, epsilon = h / 2",
            f"greatest eigenvalue {round(predicted, 3) + 0.0:.3f} D / h^alpha, from the symbol",
            f"{round(greatest, 3) + 0.0:.3f} on {setting.size} particles",
            abs(greatest - predicted) < 0.02,
            BLOWS_UP if predicted > 1e-3 else OK,
        )


def _scaling(base: Base) -> Iterator[Check]:
    """Similarity: lengths times c and times times c^alpha / D leave c u unchanged."""
    expected = f"the scaled solution of h = {base['spacing']:g}, D = 1"
    for scheme in _SCHEMES:
        dt = 0.5 * _limit(scheme, **base)
        reference = _run(scheme=scheme, dt=dt, **base).u
        for c, diffusivity in ((1e-6, 1.0), (1e6, 1.0), (1.0, 1e-6), (1.0, 1e6)):
            time = c ** (1.0 + base["beta"]) / diffusivity
            lengths = {name: c * base[name] for name in ("half_width", "spacing")}
            times = {"t_initial": 0.5 * time, "t_final": 1.5 * time, "dt": dt * time}
            fields = {"beta": base["beta"], "diffusivity": diffusivity, **lengths, **times}
            run = _run(scheme=scheme, **fields)
            case = f"{scheme}, h = {run.case.spacing:.0e}, D = {diffusivity:.0e}"
            yield _same(case, expected, c * run.u, reference)


def _linearity(base: Base) -> Iterator[Check]:
    """Strengths near the ends of the range of float64."""
    for scheme in _SCHEMES:
        fields = {**base, "scheme": scheme, "integrator": "exponential"}
        reference = _run(**fields)
        for size in (1e-300, 1e300):
            u = _run(size * reference.u0, **fields).u / size
            case = f"{scheme}, strengths times {size:.0e}"
            yield _same(case, "the solution times the same", u, reference.u)


def _field(run: Solution) -> np.ndarray:
    """u_eps(x_i) = sum_j V_j u_j eta_eps(x_i - x_j), Eq. (7), with eta of (8)."""
    s = run.case.resolved_overlap
    m = np.arange(-ceil(7.0 * s), ceil(7.0 * s) + 1)  # exp(-49) is below round-off
    return np.convolve(run.u, np.asarray(kernel("eta", m / s, run.case.alpha)) / s, mode="same")


def _long_times(base: Base) -> Iterator[Check]:
    """t_f = 10^6 t_0: with the open exterior the exact solution, on a closed lattice the mean or nothing."""
    fields = {"beta": 0.9, "half_width": 4000.0, "spacing": 1.0, "t_initial": 1.0, "t_final": 1e6}
    for scheme in _SCHEMES:
        run = _run(scheme=scheme, integrator="exponential", exterior="open", **fields)
        exact = green(run.x, 1e6, 1.9)
        near = np.abs(run.x) <= 2000.0
        difference = float(np.abs(_field(run) / exact - 1.0)[near].max())
        yield (
            f"{scheme}, beta = 0.9, t_f / t_0 = 10^6, open exterior",
            "field (7) is the exact solution, relative error below 10^-2 for |x| < D / 2",
            f"largest relative error {difference:.1e}",
            difference < 1e-2,
        )
    closed = {"beta": 0.5, "half_width": 10.0, "spacing": 0.1, "integrator": "exponential"}
    run = _run(scheme="KPSE", t_final=1e3, **closed)
    case = "KPSE, truncated, D = 10, t_f = 10^3"
    expected = "the mean of the initial strengths: conservative and symmetric"
    yield _same(case, expected, run.u, np.full_like(run.u, run.u0.mean()), "mean")
    run = _run(scheme="DD", t_final=100.5, **closed)
    values, modes = np.linalg.eigh(_matrix(run.case.setting, "DD"))
    predicted = modes @ (np.exp(100.0 * values) * (modes.T @ run.u0))
    left, found = predicted.sum() / run.u0.sum(), run.u.sum() / run.u0.sum()
    yield (
        "DD, truncated, D = 10, t_f = 100",
        f"leaks as its {values.size} modes decay: {left:.6e} of the total strength is left",
        f"{found:.6e}",
        abs(found / left - 1.0) < _SAME,
    )


def _point_data(base: Base) -> Iterator[Check]:
    """All strength on one particle: the wave of two particles, and order.

    The transforms of G, F and eta1 are almost zero or zero at theta = k h = pi: DD and FPSE hardly damp the wave
    (-1)^i, and from rough data it is their strengths, not the scheme's smooth part, that stay wrong.
    """
    fields = {**base, "half_width": 20.0, "integrator": "exponential"}
    for scheme in _SCHEMES:
        run = _run(_point, **{**fields, "spacing": 0.05}, scheme=scheme)
        setting = run.case.setting
        symbol = float(SCHEMES[scheme].symbol(np.array([np.pi]), setting)[0])
        predicted = float(np.exp(symbol * setting.rate))
        wave = (-1.0) ** np.arange(run.x.size)
        found = float(wave @ run.u / (wave @ run.u0))
        yield (
            f"{scheme}, one particle of strength 1 / h, T = 1, h = 0.05",
            f"wave of two particles keeps {predicted:.4f} of its amplitude, from the symbol",
            f"{found:.4f}",
            abs(found - predicted) < 0.02,
        )
    errors = []
    for h in (0.1, 0.05):
        run = _run(_point, **{**fields, "spacing": h}, scheme="KPSE", exterior="open")
        exact = np.asarray(green(run.x, 1.0, 1.0 + base["beta"]))
        errors.append(float(np.abs(run.u - exact).sum() / exact.sum()))
    case = "KPSE, one particle of strength 1 / h, T = 1, h = 0.1 and 0.05"
    expected = "the fundamental solution, error falls 4 times"
    yield _falls_four_times(case, expected, errors)


def _signs(base: Base) -> Iterator[Check]:
    """One particle: the sign of the weights."""
    fields = {**base, "integrator": "exponential"}
    kernels = (("KPSE", 2, 0.5, True), ("KPSE", 4, 0.5, True), ("KPSE", 4, 0.9, False))
    for scheme, order, beta, positive in (*kernels, ("DD", 2, 0.5, False)):
        fields |= {"beta": beta, "scheme": scheme, "order": order}
        # Short enough to see the weights themselves: u = u0 + A u0 T + ...
        setting = Case(**fields).setting
        matrix = _matrix(setting, scheme)
        off_diagonal = matrix[~np.eye(setting.size, dtype=bool)].min() / setting.rate
        run = _run(_point, t_final=0.5 + 0.01 / setting.rate, **fields)
        least, becomes = (
            float(run.u.min() / run.u.max()),
            "stays positive" if positive else "turns negative",
        )
        yield (
            f"{scheme}, order {order}, beta = {beta:g}, one particle, T D = 0.01 h^alpha",
            f"least weight {off_diagonal:.1e} D / h^alpha: u {becomes}",
            f"least u {least:.1e} of the peak",
            (off_diagonal >= 0.0) == positive and (least >= -_SAME) == positive,
        )


def _rough_data(base: Base) -> Iterator[Check]:
    fields = {**base, "scheme": "KPSE", "integrator": "exponential"}
    run = _run(lambda x: np.random.default_rng(1).uniform(-1.0, 1.0, x.size), **fields)
    yield (
        "KPSE, order 2, random strengths in [-1, 1]",
        "stays within the initial bounds",
        f"{run.u.min():.3f} to {run.u.max():.3f}",
        run.u.min() >= run.u0.min() and run.u.max() <= run.u0.max(),
    )


def _point(x: np.ndarray) -> np.ndarray:
    u = np.zeros_like(x)
    u[x.size // 2] = 1.0 / (x[1] - x[0])
    return u


# --- stiffness and non-normality --------------------------------------------------------------------------------------


def _stiff_exponential(base: Base) -> Iterator[Check]:
    """A lattice on which RK2 needs a million steps: the series of exp(A T) against the modes of A."""
    fields = {"beta": 0.9, "half_width": 0.2, "spacing": 1e-3, "integrator": "exponential"}
    for scheme in _SCHEMES:
        span = 1e6 * _limit(scheme, **{**fields, "integrator": "rk2"})
        run = _run(_rough, scheme=scheme, **fields, t_final=0.5 + span)
        values, modes = np.linalg.eig(_matrix(run.case.setting, scheme))
        exact = (modes @ (np.exp(values * span) * np.linalg.solve(modes, run.u0))).real
        difference = float(np.abs(run.u - exact).max() / np.abs(run.u0).max())
        yield (
            f"{scheme}, beta = 0.9, h = 10^-3, T = 10^6 steps of RK2 at its limit",
            f"exp(A T) from the {values.size} modes, 0 <= |u| <= {np.abs(exact).max():.3g}",
            f"difference {difference:.1e}, {run.operator_applications} operator applications",
            # eps |A| T = 4e-10, times the condition of FPSE's modes, some hundred
            difference < 1e-7,
        )


def _rough(x: np.ndarray) -> np.ndarray:
    return np.random.default_rng(2).uniform(0.0, 1.0, x.size)


def _work(beta: float) -> pd.DataFrame:
    """Operator applications against T D / h^alpha: RK2 at 0.99 of its limit, its series and the exponential."""
    low, _ = symbol_range("KPSE", beta)
    rows = []
    for stiffness in 10.0 ** np.arange(1.0, 7.5, 0.5):
        steps, scaled = int(np.ceil(0.5 * -low * stiffness / 0.99)), low * stiffness
        series = integrators.power(_RK2, 1.0 / steps, steps, scaled, 0.0)
        rows.append(("RK2, stepping", stiffness, 2 * steps))
        rows.append(("RK2, one series", stiffness, series.degree))
        rows.append(("exponential", stiffness, integrators.exponential(1.0, scaled, 0.0).degree))
    return pd.DataFrame(rows, columns=["series", "x", "y"]).assign(panel="work")


def _transient_growth(base: Base) -> Iterator[Check]:
    """|exp(A t)| in the Euclidean norm: at most 1 for symmetric A; for FPSE at most the condition of its modes."""
    times = np.geomspace(0.01, 1e6, 60)
    for scheme in _SCHEMES:
        matrix = _matrix(Setting(n=50, spacing=1.0, alpha=1.0 + base["beta"]), scheme)
        values, modes = np.linalg.eig(matrix)
        greatest, condition = float(values.real.max()), float(np.linalg.cond(modes))
        most = max(float(np.linalg.norm(expm(t * matrix), 2)) for t in times)
        if scheme == "FPSE":
            bound = f"above 1, at most {condition:.0f}, the condition of the modes"
            holds = 1.0 + _SAME < most <= condition
        else:
            bound, holds = "at most 1", most <= 1.0 + _SAME
        yield (
            f"{scheme}, 101 particles, t D up to 10^6 h^alpha",
            f"no eigenvalue above zero; |exp(A t)| {bound}",
            f"greatest eigenvalue {greatest:.0e}, |exp(A t)| at most {most:.6g}",
            greatest < _SAME and holds,
        )


_CHECKS: dict[str, Callable[[Base], Iterator[Check]]] = {
    "overflow": _overflow,
    "series and stepping": _edge_of_stability,
    "extreme order": _extreme_orders,
    "small overlap": _small_overlap,
    "scaling": _scaling,
    "linearity": _linearity,
    "long time": _long_times,
    "point data": _point_data,
    "sign": _signs,
    "rough data": _rough_data,
    "stiff": _stiff_exponential,
    "transient growth": _transient_growth,
}
