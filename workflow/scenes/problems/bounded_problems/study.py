"""Problems with exact solutions on bounded domains, what they conserve, and a profile that is carried."""

from collections.abc import Callable, Iterator
from functools import partial
from math import gamma
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.bounded.closed_forms import power_in_ball, riesz_of_power
from fracparticles.problems import Problem, solve_problem
from fracparticles.variable.closed_forms import Cauchy
from fracstudy.errors import off, power_of_ten, three_digits
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import observed
from fracstudy.panels import Panels

_solved = partial(solve_problem, estimate=False)  # the errors are measured
_ROUNDING = 1e-13  # a drift below is written as that
_PLANE_POWER = 5.0  # of the bump on the square, zero near its edges
_TURN = 3  # angles of the disc that the solution is turned by

Known = tuple[dict[str, Any], Callable[..., Any], Callable[..., Any]]
"""The fields of a problem, its initial data, and u at t = 1, both of the places."""


def study(
    inputs: Inputs,
    *,
    alphas: list[float],
    drawn: float,
    counts: dict[str, list[int]],
    rtol: dict[str, float],
) -> Result:
    """A row for each domain, problem, alpha and number of particles; the time is as exact as `rtol`."""
    panels = Panels()
    rows: list[dict[str, Any]] = []
    for alpha in alphas:
        for domain, problems in _problems(alpha).items():
            for name, known in problems.items():
                rows += _levels(domain, name, alpha, counts[domain], rtol[domain], known, panels)
        rows += _kept(alpha, counts)
        rows.append(_turned(alpha, counts["disc"][-1]))
    _profiles(drawn, counts["interval"][-1], panels)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _row(
    domain: str, problem: str, exterior: str, alpha: float, n: int, found: dict[str, float]
) -> dict[str, Any]:
    row = {"domain": domain, "problem": problem, "exterior": exterior, "alpha": alpha}
    return {**row, "particles": n, **found}


def _on(domain: str, alpha: float, particles: int, **fields: Any) -> Problem:
    at = {"domain": domain, "alpha": alpha, "half_width": 1.0, "particles": particles}
    return Problem(**{"t_final": 1.0, **at, **fields})


def _problems(alpha: float) -> dict[str, dict[str, Known]]:
    theirs = {"D(x, t)": _diffusivity(alpha), "a(x, t)": _velocity(alpha, 1)}
    plane = {"a(x, y)": _velocity(alpha, 2)}
    square = {"a(x, y)": _velocity(alpha, 2, _PLANE_POWER)}
    return {
        "interval": {**theirs, "D, a, g": _outside(alpha, 1)},
        "disc": {**plane, "a, g": _outside(alpha, 2)},
        "square": {**square, "a, g": _outside(alpha, 2)},
    }


def _diffusivity(alpha: float) -> Known:
    """u = e^-t (1 - x^2)^(alpha/2), grad^beta u = -Gamma(1 + alpha) x e^-t, D = 1 + x cos(t) / 2."""

    def source(x: np.ndarray, t: float) -> Any:
        spread = gamma(1.0 + alpha) * (1.0 + x * np.cos(t))
        return np.exp(-t) * (spread - power_in_ball(x * x, 0.5 * alpha))

    fields = {"exterior": "absorbing", "diffusivity": "1 + 0.5*x*cos(t)", "source": source}
    return fields, *_decaying(lambda x: power_in_ball(x * x, 0.5 * alpha))


def _decaying(f: Callable[..., Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    return f, lambda *place: np.exp(-1.0) * f(*place)


def _velocity(alpha: float, dim: int, power: float | None = None) -> Known:
    """u = e^-t (1 - r^2)_+^p, p = alpha/2 + 1 if not given, a = cos(3 t) (1 + x), in the plane (1 + y, 1/2)."""
    p = power or 0.5 * alpha + 1.0
    still = _Kept(lambda *place: riesz_of_power(_squared(*place), alpha, p, dim))

    def source(*arguments: Any) -> Any:
        *place, t = arguments
        r2 = _squared(*place)
        bend = -2.0 * p * power_in_ball(r2, p - 1.0)
        u = power_in_ball(r2, p)
        if dim == 1:
            moved = np.cos(3.0 * t) * (u + (1.0 + place[0]) * place[0] * bend)
        else:
            moved = ((1.0 + place[1]) * place[0] + 0.5 * place[1]) * bend
        return np.exp(-t) * (still(*place) - u + moved)

    fields = {
        "exterior": "absorbing",
        "velocity": "cos(3*t)*(1 + x)" if dim == 1 else ("1 + y", "0.5"),
        "source": (lambda x, t: source(x, t)) if dim == 1 else (lambda x, y, t: source(x, y, t)),
    }
    return fields, *_decaying(lambda *place: power_in_ball(_squared(*place), p))


def _outside(alpha: float, dim: int) -> Known:
    """u = e^-t (1 + |x|^2)^(-(n+1)/2), D = 1 + x cos(t) / 3 and a = x on the line, in the plane 1 and (1, 0)."""

    def value(*place: Any) -> Any:
        return Cauchy.value(list(place))

    still = _Kept(lambda *place: Cauchy.riesz(list(place), alpha))
    flux = _Kept(lambda *place: Cauchy.gradient(list(place), alpha)[0])

    def source(*arguments: Any) -> Any:
        *place, t = arguments
        u, x = value(*place), place[0]
        slope = -(dim + 1.0) * x / (1.0 + _squared(*place)) * u
        if dim == 1:
            c = np.cos(t) / 3.0
            return np.exp(-t) * ((1.0 + x * c) * still(x) - c * flux(x) + x * slope)
        return np.exp(-t) * (still(*place) - u + slope)

    data = "exp(-t)/(1 + x**2)" if dim == 1 else "exp(-t)*(1 + x**2 + y**2)**(-1.5)"
    fields: dict[str, Any] = {"exterior": "given", "exterior_data": data}
    fields["velocity"] = "x" if dim == 1 else (1.0, 0.0)
    fields["source"] = (lambda x, t: source(x, t)) if dim == 1 else lambda x, y, t: source(x, y, t)
    if dim == 1:
        fields["diffusivity"] = "1 + x*cos(t)/3"
    return fields, *_decaying(value)


class _Kept:
    """A function of the places, kept for those of the last problem."""

    def __init__(self, f: Callable[..., Any]) -> None:
        self._f, self._at, self._values = f, None, None

    def __call__(self, *place: Any) -> Any:
        key = place[0].tobytes()
        if key != self._at:
            self._at, self._values = key, self._f(*place)
        return self._values


def _squared(*place: Any) -> Any:
    return sum(np.square(part) for part in place)


def _levels(
    domain: str,
    name: str,
    alpha: float,
    counts: list[int],
    rtol: float,
    known: Known,
    panels: Panels,
) -> Iterator[dict[str, Any]]:
    """Errors at t = 1 by the number of particles."""
    fields, start, end = known
    greatest, means = [], []
    for count in counts:
        problem = _on(domain, alpha, count, rtol=rtol, **fields)
        run = _solved(problem, start)
        exact, total = end(*problem.bounded_domain.points), problem.bounded_domain.total
        greatest.append(off(run.u.values, exact))
        means.append(total(np.abs(run.u.values - exact)) / total(np.abs(exact)))
    panels.add(domain, name, counts, means, alpha=alpha)
    orders = observed([1.0 / n for n in counts], means)
    theory = {"interval": 8.0 - alpha, "disc": 4.0 - alpha}.get(domain, np.nan)
    for count, most, mean, order in zip(counts, greatest, means, orders, strict=True):
        errors = {"error": three_digits(most), "mean error": three_digits(mean)}
        found = {**errors, "observed order": order, "of theory": theory}
        yield _row(domain, name, fields["exterior"], alpha, count, found)


def _bell(*place: Any) -> Any:
    return np.exp(-8.0 * _squared(place[0] - 0.3, *place[1:]))


def _kept(alpha: float, counts: dict[str, list[int]]) -> Iterator[dict[str, Any]]:
    """The total where nothing leaves, with a diffusivity and a velocity that vary, at t = 1."""
    along: dict[str, Any] = {
        "interval": "1 - x**2",
        "disc": ("-y", "x"),
        "square": ("(1 - x**2)*cos(t)", "x*(1 - y**2)"),
    }
    for domain, velocity in along.items():
        count = counts[domain][1]
        acts = {"diffusivity": "1 + 0.5*x*cos(t)", "velocity": velocity}
        kept = {"exterior": "reflecting", "form": "exchange"}
        run = _solved(_on(domain, alpha, count, **kept, **acts), _bell)
        drift = power_of_ten(float(run.mass_final / run.mass_initial) - 1.0, _ROUNDING)
        found = {"drift of the total": drift}
        yield _row(domain, "D(x, t), a", "reflecting", alpha, count, found)


def _turned(alpha: float, rings: int) -> dict[str, Any]:
    """A rotation against what does not turn, turned after."""
    fields = {"exterior": "absorbing", "t_final": 0.5, "rtol": 1e-8}
    still = _solved(_on("disc", alpha, rings, **fields), _bell)
    speed = 2.0 * np.pi * _TURN / still.sizes["angle"] / 0.5
    fields["velocity"] = (f"-{speed}*y", f"{speed}*x")
    turned = _solved(_on("disc", alpha, rings, **fields), _bell)
    error = three_digits(off(turned.u.values, np.roll(still.u.values, _TURN, axis=1)))
    return _row("disc", "rotation", "absorbing", alpha, rings, {"error": error})


def _profiles(alpha: float, particles: int, panels: Panels) -> None:
    """A bump that a = 4 (1 - x^2) carries to the right, with D = 1 and D = 0.2, at t = 0.2."""
    for exterior in ("absorbing", "reflecting"):
        for d in (1.0, 0.2):
            carried = {"diffusivity": d, "velocity": "4*(1 - x**2)", "t_final": 0.2}
            problem = _on("interval", alpha, particles, exterior=exterior, **carried)
            run = _solved(problem, lambda x: _bell(x + 0.6))
            panels.add("profile", exterior, run.x.values, run.u.values, alpha=d)
