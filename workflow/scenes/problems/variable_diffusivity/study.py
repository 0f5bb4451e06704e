"""div(D(x) grad^beta u) by three forms: which equation each solves, and to what order.

On the line u = 1 / (1 + x^2), in the plane u = exp(-|x|^2), whose fractional derivatives are closed forms, and
D = 1 + c u. The error is the greatest over the particles, over the greatest value of the exact right-hand side; what is
tested is the operator alone.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.problems import Problem, solve_problem
from fracparticles.schemes.setting import Setting
from fracparticles.variable import VariableDiffusivity
from fracparticles.variable.closed_forms import Cauchy, Gaussian, KnownField, exchange_limit
from fracstudy.errors import off
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import observed
from fracstudy.panels import Panels

_solved = partial(solve_problem, estimate=False)  # the errors are measured
_FLUX, _MEAN = "div(D grad^beta u)", "(D L u + L(D u) - u L D) / 2"
_RUN = "u_t = div(D grad^beta u) + f"
_FAR = 6.0  # half-width of a run, where exp(-x^2) is 2e-16
_SHORT = 4.0  # half-width of a truncated lattice, that loses something if it is not conservative
_SHOWN = 8.0  # half-width of what is drawn of the right-hand sides


def study(
    inputs: Inputs,
    *,
    alpha: float,
    amplitude: float,
    overlap: float,
    half_width: float,
    spacings: list[float],
    orders: list[int],
    plane_half_width: float,
    plane_spacings: list[float],
    plane_orders: list[int],
    alphas: list[float],
    runs: list[list[Any]],
) -> Result:
    """A row for each form, equation, order and spacing, and for each run; how far apart the two equations are."""
    panels = Panels()
    common: dict[str, Any] = {"alpha": alpha, "overlap": overlap, "exterior": "open"}
    rows: list[dict[str, Any]] = []
    for form, equation, order in _line_cases(orders):
        settings = [
            Setting(**common, order=order, n=round(half_width / h), spacing=h, far_terms=3)
            for h in spacings
        ]
        rows += _levels(form, equation, settings, amplitude, panels)
    for form in ("FPSE", "DD"):
        for order in plane_orders:
            settings = [
                Setting(**common, order=order, dim=2, n=round(plane_half_width / h), spacing=h)
                for h in plane_spacings
            ]
            rows += _levels(form, _FLUX, settings, amplitude, panels)
    rows += [_run(alpha, *run) for run in runs]
    _two_equations(alpha, amplitude, alphas, panels)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _line_cases(orders: Sequence[int]) -> Iterator[tuple[str, str, int]]:
    for form in ("FPSE", "DD"):
        for order in orders:
            yield form, _FLUX, order
    for equation in (_FLUX, _MEAN):
        yield "exchange", equation, 2
    if 4 in orders:
        yield "exchange", _MEAN, 4


def _levels(
    form: str, equation: str, settings: Sequence[Setting], c: float, panels: Panels
) -> Iterator[dict[str, Any]]:
    """One row a spacing."""
    spacings = [setting.spacing for setting in settings]
    errors, drifts, norms = [], [], []
    for setting in settings:
        operator = VariableDiffusivity(form, setting, tail=setting.dim + 1.0)
        u, exact = _given(setting, equation, c)
        d = 1.0 + c * _field(setting).value(operator.points)
        rate = operator.apply(u, d)
        errors.append(off(rate, exact))
        norms.append(operator.spectral_radius(d) * setting.spacing**setting.alpha)
        drifts.append(_drift(form, setting, c))
    dim, order = settings[0].dim, settings[0].order
    where = "line" if dim == 1 else "plane"
    panels.add(where, form, spacings, errors, order=order, equation=equation)
    levels = zip(spacings, errors, observed(spacings, errors), drifts, norms, strict=True)
    for h, error, slope, drift, norm in levels:
        more = {"drift of the total": drift, "bound of |lambda| h^alpha": norm}
        yield {**_row(dim, form, equation, order, h, error), "observed order": slope, **more}


def _row(dim: int, way: str, equation: str, order: int, h: float, error: float) -> dict[str, Any]:
    return {"dim": dim, "way": way, "equation": equation, "order": order, "h": h, "error": error}


def _field(setting: Setting) -> type[KnownField]:
    return Cauchy if setting.dim == 1 else Gaussian


def _given(setting: Setting, equation: str, c: float) -> tuple[np.ndarray, np.ndarray]:
    """u at the particles, and the right-hand side of an equation there."""
    at, field, alpha = setting.positions, _field(setting), setting.alpha
    u = field.value(at)
    if equation == _MEAN:
        return u, exchange_limit(at[0], alpha, c)
    slopes = [c * part for part in field.gradient(at, 2.0)]  # beta = 1 is the gradient
    return u, field.flux_divergence(at, alpha, 1.0 + c * u, slopes)


def _drift(form: str, setting: Setting, c: float) -> float:
    """The rate of the total strength over the sum of |du/dt|, on a truncated lattice: zero if conservative."""
    n = round(_SHORT / setting.spacing)
    truncated = replace(setting, n=n, exterior="truncated", far_terms=1)
    operator = VariableDiffusivity(form, truncated)
    field = _field(truncated)
    u, d = field.value(truncated.positions), 1.0 + c * field.value(operator.points)
    rate = operator.apply(u, d)
    return float(abs(rate.sum()) / np.abs(rate).sum())


def _run(alpha: float, form: str, dim: int, order: int, h: float) -> dict[str, Any]:
    """u = exp(-t - |x|^2) with D = 1 + exp(-|x|^2) cos(t) / 2, by the source that makes it, to t = 1."""

    def swing(points: Sequence[np.ndarray], t: Any) -> np.ndarray:
        return np.asarray(0.5 * Gaussian.value(points) * np.cos(t))

    def diffusivity(*at: np.ndarray) -> np.ndarray:
        return 1.0 + swing(at[:dim], at[dim])

    def source(*at: np.ndarray) -> np.ndarray:
        points, t = at[:dim], at[dim]
        d = swing(points, t)
        spread = Gaussian.flux_divergence(points, alpha, 1.0 + d, [-2.0 * x * d for x in points])
        return np.asarray(-np.exp(-t) * (Gaussian.value(points) + spread))

    problem = Problem(
        diffusivity=diffusivity, source=source, alpha=alpha, dim=dim, form=form, order=order, spacing=h,
        half_width=_FAR, t_final=1.0, rtol=1e-8,
    )  # fmt: skip
    at = problem.case.setting.positions
    start = Gaussian.value(at)
    run = _solved(problem, start)
    error = off(run["u"].values, np.exp(-1.0) * start)
    return _row(dim, form, _RUN, order, h, error)


def _two_equations(alpha: float, c: float, alphas: Sequence[float], panels: Panels) -> None:
    """The two right-hand sides, and how far apart they are for other alpha; both closed forms."""
    fine = Setting(alpha=alpha, n=400, spacing=_SHOWN / 400.0)
    x = fine.x
    for equation in (_FLUX, _MEAN):
        panels.add("right-hand side", equation, x, _given(fine, equation, c)[1])
    ours = replace(fine, order=4, n=1600, exterior="open", far_terms=3)
    operator = VariableDiffusivity("exchange", ours, tail=2.0)
    at = ours.x
    rate = operator.apply(Cauchy.value([at]), 1.0 + c * Cauchy.value(operator.points))
    near = np.flatnonzero(np.abs(at) <= _SHOWN)[::10]
    panels.add("right-hand side", "exchange", at[near], rate[near])
    gaps = []
    for one in alphas:
        setting = Setting(alpha=one, n=400, spacing=_SHOWN / 400.0)
        first, second = (_given(setting, equation, c)[1] for equation in (_FLUX, _MEAN))
        gaps.append(off(second, first))
    panels.add("gap", "gap", [2.0 - one for one in alphas], gaps)
