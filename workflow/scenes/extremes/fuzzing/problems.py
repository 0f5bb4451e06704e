"""What holds of problems whose coefficients vary, in space and in time."""

# ruff: noqa: B008  an argument of a property is drawn from its default

import json
import math
import re
from typing import Any

import numpy as np
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.linalg import expm

import fracparticles as fp
from fracparticles.problems.problem import Problem
from fracparticles.problems.rates import Rates
from fracparticles.problems.solve import solve_problem
from fracparticles.variable import FORMS
from scenes.extremes.fuzzing.harness import always
from scenes.extremes.fuzzing.strategies import among, anything, between, given_fields, texts

_TOLERANCE = 1e-6  # rtol of the problems
_ALLOWED = 100.0 * _TOLERANCE  # of the greatest |u| of a run: errors of the steps add up
_ALPHAS = st.one_of(between(1.05, 1.95), among(1.01, 1.99))
_ROUGH = "where(x > 0.3, 1, 0.1)"
_DIFFUSIVITIES = (1.0, 0.3, "1 + 0.5*tanh(x)", "0.2 + exp(-x**2)", _ROUGH, "1 + x/(1 + x**2)")
_VELOCITIES = (None, 0.5, "-0.3*x", "sin(x)", "where(x > 0, -0.5, 0.5)", "x/(1 + x**2)")
_SOURCES = (None, None, "exp(-x**2)", "1/(1 + (x - 1)**2)", "where(x > 0.3, 0.1, 0)")
_IN_TIME = ("1 + 0.5*cos(3*t)", "(1 + 0.5*tanh(x))*(1.1 + sin(t))")
_NEAR = 0.1  # of a run with three particles and more across, in the relative 1-norm
_UNITS = (2.0**-100, 2.0**-20, 2.0**-7, 2.0**7, 2.0**20, 2.0**100)  # of length and time


@st.composite
def _problems(draw: st.DrawFn, *, steady: bool = False, **wanted: Any) -> Problem:
    """Draw a problem on the line whose coefficients vary, linear; `steady`: none of them in time."""
    form = draw(st.sampled_from(tuple(FORMS)))
    fields: dict[str, Any] = {
        "alpha": draw(_ALPHAS),
        "form": form,
        "diffusivity": draw(st.sampled_from(_DIFFUSIVITIES if steady else _DIFFUSIVITIES + _IN_TIME)),
        "velocity": draw(st.sampled_from(_VELOCITIES)),
        "source": draw(st.sampled_from(_SOURCES if steady else (*_SOURCES, "exp(-x**2)*cos(4*t)"))),
        "order": draw(among(2, 4)),
        "exterior": draw(among("open", "truncated")),
        "half_width": 8.0,
        "spacing": 8.0 / draw(st.integers(10, 30)),
        "t_final": draw(among(1e-3, 0.1, 0.5, 1.0)),
        "integrator": draw(among("auto", "auto", "rkc2", "dop853")),
    }  # fmt: skip
    given = {name: value for name, value in (fields | wanted).items() if value is not None}
    return Problem(**given)


def _data(problem: Problem, seed: int) -> np.ndarray:
    """Two bells near the middle."""
    random, x = np.random.default_rng(seed), problem.case.x
    (c, d), (a, b) = random.uniform(-2.0, 2.0, 2), random.uniform(-1.0, 1.0, 2)
    return np.asarray(a * np.exp(-((x - c) ** 2)) + b / (1.0 + (x - d) ** 2))


def _solved(problem: Problem, u0: np.ndarray) -> np.ndarray:
    return np.asarray(solve_problem(problem, u0).u.values).reshape(-1)


def _apart(u: np.ndarray, v: np.ndarray, *of: np.ndarray) -> float:
    size = max(float(np.abs(one).max()) for one in (u, v, *of))
    return float(np.abs(u - v).max()) / (_ALLOWED * size) if size > 0.0 else 0.0


_SEEDS = st.integers(0, 10**6)
_JSON = st.one_of(
    anything(),
    given_fields(Problem),
    given_fields(Problem).map(lambda given: json.dumps(given, default=str)),
    st.tuples(_problems(), st.integers(0, 300), texts()).map(
        lambda parts: parts[0].to_json()[: parts[1]] + parts[2] + parts[0].to_json()[parts[1] :]
    ),
    _problems().map(lambda problem: problem.to_json()),
)
_STEADY = _problems(steady=True)
_CONSERVING = st.one_of(
    *(_problems(form=form, exterior="truncated") for form in ("FPSE", "exchange"))
)


@always("text of a problem", "a whole problem, or a line", share=8)
def _text(given=_JSON):
    """A problem of any text or fields is refused, or is one that its own text gives again."""
    problem = Problem(**given) if isinstance(given, dict) else Problem.from_json(given)
    if not problem.reproducible:
        return 0.0
    again = Problem.from_json(problem.to_json())
    return 2.0 * (again.to_json() != problem.to_json() or again.case != problem.case)


@always("a problem, matrix", "exp(A T) u, to 100 rtol, or a warning", "scipy, dense matrix", 2)
def _matrix(problem=_STEADY, seed=_SEEDS):
    """R(u) = A u + b by unit vectors, and its exponential; a mode that grows makes errors grow."""
    u0 = _data(problem, seed)
    rates, n, t = Rates(problem), u0.size, problem.t_initial
    b = rates(t, np.zeros(n))
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n] = np.array([rates(t, one) - b for one in np.eye(n)]).T
    whole[:n, n] = b
    step = expm(0.25 * problem.span * whole)
    powers = [np.linalg.matrix_power(step, k) for k in range(1, 5)]
    seen = [one[:n, :n] @ u0 + one[:n, n] for one in powers]
    growth = max(1.0, *(float(np.linalg.norm(one[:n, :n], 2)) for one in powers))
    return _apart(_solved(problem, u0), seen[-1], u0, *seen) / growth


@always(
    "a problem, closed form", f"Ornstein and Uhlenbeck, to {_NEAR:g}, or a warning", "closed form"
)
def _known(
    alpha=between(1.1, 1.95),
    form=st.sampled_from(tuple(FORMS)),
    c=between(0.05, 2.0),
    v=between(-3.0, 3.0),
    d=among(0.1, 1.0, 3.0),
    across=st.integers(3, 6),
):
    """a = v - c x and constant D, from the fundamental solution: one about v (1 - e) / c, e = exp(-c t), of the width

    l^alpha = e^alpha + D (1 - e^alpha) / (alpha c).
    """
    e = math.exp(-c)
    end = e**alpha + d * (1.0 - e**alpha) / (alpha * c)
    width = min(1.0, end ** (1.0 / alpha))
    half_width = 10.0 * (1.0 + end ** (1.0 / alpha)) + abs(v) / min(c, 1.0)
    problem = Problem(
        alpha=alpha, form=form, diffusivity=d, velocity=f"{v!r} - {c!r}*x", half_width=half_width,
        spacing=width / across, t_final=1.0,
    )  # fmt: skip
    x = problem.case.x
    found = _solved(problem, np.asarray(fp.green(x, 1.0, alpha)))
    exact = np.asarray(fp.green(x - v * (1.0 - e) / c, end, alpha))
    return float(np.abs(found - exact).sum() / exact.sum()) / _NEAR


# --- all ------------------------------------------------------------------------------------------------------


@always("a problem, other units", "the same, or a warning")
def _scaled(
    problem=_problems(), seed=_SEEDS, length=st.sampled_from(_UNITS), time=st.sampled_from(_UNITS)
):
    """The same in other units of length and of time."""
    u0 = _data(problem, seed)
    rate = length**problem.order_coefficient.constant * length / time

    def other(given: Any, factor: float) -> Any:
        if given is None or not isinstance(given, str):
            return None if given is None else factor * given
        units = {"x": f"(x/{length!r})", "t": f"(t/{time!r})"}
        words = re.sub(r"\b[xt]\b", lambda name: units[name[0]], given)
        return f"{factor!r}*({words})"

    changed = {
        "diffusivity": other(problem.diffusivity, rate),
        "velocity": other(problem.velocity, length / time),
        "source": other(problem.source, 1.0 / time),
        "half_width": length * problem.half_width,
        "spacing": length * problem.case.particle_spacing,
        "t_final": time * problem.t_final,
    }
    fields = {name: value for name, value in changed.items() if value is not None}
    return _apart(_solved(problem.model_copy(update=fields), u0), _solved(problem, u0), u0)


@always("a problem, in two parts", "the problem at once, or a warning")
def _halves(problem=_problems(), seed=_SEEDS):
    """To the middle, and from there to the end."""
    u0 = _data(problem, seed)
    middle = 0.5 * problem.t_final
    half = _solved(problem.model_copy(update={"t_final": middle}), u0)
    last = _solved(problem.model_copy(update={"t_initial": middle}), half)
    return _apart(last, _solved(problem, u0), u0, half)


@always("a problem, its total", "what the source gives, or a warning", "scipy, quadrature")
def _mass(problem=_CONSERVING, seed=_SEEDS):
    """The total gains what the source gives, by quadrature in time; nothing leaves a truncated lattice."""
    u0 = _data(problem, seed)
    h, f = problem.case.particle_spacing, problem.reaction
    given = 0.0
    if f is not None:
        where = {"x": problem.case.x, "u": np.zeros(u0.size)}
        rate = lambda t: float(f({**where, "t": np.array(t)}).sum())
        given = quad(rate, 0.0, problem.t_final, epsrel=1e-10)[0]
    found = _solved(problem, u0)
    size = float(np.abs(u0).sum() + np.abs(found).sum())
    return abs(float(found.sum() - u0.sum() - given)) / (_ALLOWED * size) if h > 0.0 else 2.0
