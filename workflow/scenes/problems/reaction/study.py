"""Reactions and sources: the fractional Fisher-KPP front, decay, a manufactured source, blow-up."""

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from fracparticles.adaptive.follow import follow
from fracparticles.errors import NonFiniteSolution
from fracparticles.problems import Problem, solve_problem
from fracparticles.run.orders import observed_order
from fracparticles.special import green
from fracparticles.variable.closed_forms import Gaussian
from fracstudy.errors import off, quiet
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_solved = partial(solve_problem, estimate=False)  # the errors are measured
_LEVEL = 0.5  # of the front
_LINE: dict[str, Any] = {"alpha": 1.5, "half_width": 50.0, "far_terms": 3}


def study(
    inputs: Inputs,
    *,
    alphas: list[float],
    drawn: float,
    half_width: float,
    spacing: float,
    until: list[int],
    followed_until: list[int],
    followed_reach: float,
    plane_half_width: float,
    plane_spacing: float,
    plane_until: int,
    tolerances: list[float],
    source_spacings: list[float],
    decay: float,
) -> Result:
    """A row for each number that is known: the rate of the front, a factor, an order, a time."""
    panels = Panels()
    rows: list[dict[str, Any]] = []
    with quiet():  # of narrow lattices; what lies beyond is in the table
        for alpha, last in zip(alphas, until, strict=True):
            one = {"alpha": alpha, "half_width": half_width, "spacing": spacing}
            rows.append(_front_row(one, last, panels, shown=alpha == drawn))
        for alpha, last in zip(alphas, followed_until, strict=True):
            rows.append(_followed_row(alpha, last, followed_reach, panels))
        plane = {"alpha": 1.5, "half_width": plane_half_width, "spacing": plane_spacing}
        rows.append(_front_row({**plane, "dim": 2, "form": "exchange"}, plane_until, panels))
        rows += _decay(decay, tolerances, panels)
        rows += _manufactured(source_spacings)
        rows.append(_blow_up())
    table = pd.DataFrame(rows)
    table.insert(4, "deviation", (table["ours"] - table["exact"]).abs() / table["exact"].abs())
    return Result(table, (), panels.frame)


def _row(
    problem: str, quantity: str, exact: float, ours: float, run: Any = None, **more: Any
) -> dict[str, Any]:
    row = {"problem": problem, "quantity": quantity, "exact": exact, "ours": ours, **more}
    if run is not None:
        row["integrator"] = str(run["integrator"].values)
        row["evaluations"] = int(run["evaluations"])
    return row


def front(x: np.ndarray, u: np.ndarray) -> float:
    """Return the largest x at which u, given at x > 0, falls below the level; between particles by a power of x."""
    i = int(np.flatnonzero((u[:-1] >= _LEVEL) & (u[1:] < _LEVEL))[-1])
    share = np.log(u[i] / _LEVEL) / np.log(u[i] / u[i + 1])
    return float(x[i] * (x[i + 1] / x[i]) ** share)


def _front_row(
    fields: dict[str, Any], last: int, panels: Panels, shown: bool = False
) -> dict[str, Any]:
    """Fisher-KPP, f = u (1 - u): the front runs like exp(f'(0) t / (n + alpha)), f'(0) = 1."""
    dim, alpha = fields.get("dim", 1), fields["alpha"]
    times = tuple(float(t) for t in range(2, last + 1))
    problem = Problem(**fields, source="u*(1 - u)", times=times, order=4, rtol=1e-6)
    run = _solved(problem, _hill)
    along = run["u"] if dim == 1 else run["u"].sel(y=0.0)
    right = along.sel(x=slice(0.5 * problem.case.spacing, None))
    x = right["x"].values
    places = np.array([front(x, u) for u in right.values])
    rates = np.diff(np.log(places))
    name = f"α = {alpha:g}" + (", plane" if dim > 1 else "")
    panels.add("rate", name, times[1:], rates, exact=1.0 / (dim + alpha))
    if shown:
        some = np.unique(np.geomspace(1, x.size, 150).astype(int)) - 1
        for time, u in list(zip(times, right.values, strict=True))[1::4]:
            panels.add("front", f"{time:g}", x[some], u[some])
    quantity = f"rate of the front, α = {alpha:g}, up to t = {last}"
    where = "line" if dim == 1 else "plane"
    row = _row(f"Fisher-KPP, {where}", quantity, 1.0 / (dim + alpha), float(rates[-1]), run)
    row["beyond the lattice"] = float(run["outside_share"][-1])
    return {**row, "particles": int(run["u"].isel(t=-1).size)}


def _hill(*at: np.ndarray) -> np.ndarray:
    return np.asarray(np.exp(-sum(x * x for x in at) / 8.0))


def _followed_row(alpha: float, last: int, reach: float, panels: Panels) -> dict[str, Any]:
    """The same front on the line by particles that follow it, as far as they are told to reach."""
    times = [float(t) for t in range(2, last + 1)]
    states = follow(
        _hill, times, alpha=alpha, window=(-15.0, 15.0), step=0.2, reach=reach,
        source=lambda x, t, u: u * (1.0 - u), tolerance=1e-7,
    )  # fmt: skip
    places = []
    for state in states:
        right = state.particles.x > 0.0
        x, u = state.particles.x[right], state.u[right]
        beyond = x[u > _LEVEL][-1]
        ahead = x[x > beyond][0]
        places.append(brentq(lambda x, s=state: s.at(x) - _LEVEL, beyond, ahead))
    rates = np.diff(np.log(places))
    panels.add("followed", f"α = {alpha:g}", times[1:], np.abs(1.0 - (1.0 + alpha) * rates))
    quantity = f"rate of the front, α = {alpha:g}, up to t = {last}"
    row = _row("Fisher-KPP, line, particles", quantity, 1.0 / (1.0 + alpha), float(rates[-1]))
    return {**row, "particles": max(state.u.size for state in states)}


def _decay(c: float, tolerances: list[float], panels: Panels) -> Iterator[dict[str, Any]]:
    """u_t = .. - c u: the factor exp(-c t), for each tolerance by each integrator; the last ones in the table."""
    fields = {**_LINE, "spacing": 0.1, "order": 12, "t_initial": 1.0, "t_final": 2.0}
    for integrator in ("dop853", "rkc2"):
        errors, counts = [], []
        for rtol in tolerances:
            ways = {"rtol": rtol, "integrator": integrator}
            run = _solved(Problem(**fields, source=f"-{c}*u", **ways))
            exact = np.exp(-c) * green(run["x"].values, 2.0, 1.5)
            errors.append(off(run["u"].values, exact))
            counts.append(int(run["evaluations"]))
        panels.add("tolerance", integrator, counts, errors)
        middle = float(run["u"].sel(x=0.0) / green(0.0, 2.0, 1.5))
        quantity = f"factor, tolerance {tolerances[-1]:.0e}"
        yield _row("decay", quantity, float(np.exp(-c)), middle, run, error=errors[-1])


def _manufactured(spacings: list[float]) -> Iterator[dict[str, Any]]:
    """u = cos(t) exp(-x^2): the source that makes it, and the order in the spacing."""

    def source(x: np.ndarray, t: float) -> np.ndarray:
        bell, rate = Gaussian.value([x]), Gaussian.riesz([x], 1.5)
        return np.asarray(-np.sin(t) * bell + np.cos(t) * rate)

    for order in (4, 6):
        errors = []
        for h in spacings:
            lattice = {**_LINE, "half_width": 25.0, "spacing": h, "order": order}
            problem = Problem(**lattice, source=source, t_final=1.0, rtol=1e-11)
            run = _solved(problem, lambda x: np.exp(-x * x))
            exact = np.cos(1.0) * np.exp(-(run["x"].values ** 2))
            errors.append(off(run["u"].values, exact))
        levels = f"h = {spacings[-2]:g} and {spacings[-1]:g}"
        quantity = f"order in h, kernel of order {order}, {levels}"
        ours = float(observed_order(spacings, errors)[-1])
        yield _row("manufactured source", quantity, float(order), ours, run, error=errors[-1])


def _blow_up() -> dict[str, Any]:
    """u_t = u^2 from u = 1/2, without diffusion: infinite at t = 2, which is what the error says."""
    problem = Problem(
        alpha=1.5, half_width=5.0, spacing=0.5, diffusivity=0.0, source="u**2", t_final=3.0, order=2
    )
    said = np.nan
    try:
        _solved(problem, np.full(problem.case.shape, 0.5))
    except NonFiniteSolution as error:
        said = float(str(error).split("t = ")[1].split(":")[0])
    return _row("blow-up", "time", 2.0, said)
