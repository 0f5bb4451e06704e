"""Adaptive particles against lattices: two blobs, of widths a hundred times apart, far from one another."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.adaptive.follow import Followed, follow
from fracparticles.run.case import Case
from fracparticles.run.solve import solve
from fracparticles.time.whole_space import evolve
from fracparticles.variable.closed_forms import Cauchy, exchange_limit
from fracstudy.blobs import Blobs
from fracstudy.errors import quiet, three_digits
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

Exact = Callable[[np.ndarray, float], np.ndarray]
Solved = Iterator[tuple[float, np.ndarray, np.ndarray]]


def study(
    inputs: Inputs,
    *,
    alphas: list[float],
    drawn: float,
    widths: list[float],
    distance: float,
    steps: list[float],
    step: float,
    times: list[float],
    margin: float,
    spacings: list[float],
    scheme_spacings: list[float],
) -> Result:
    """A row for each placement at the first time, with what a lattice takes; and a row for each later time."""
    panels = Panels()
    rows: list[dict[str, Any]] = []
    for alpha in alphas:
        blobs, time = Blobs(alpha, widths, distance), times[0]
        lattice = _errors(blobs, time, _lattice(blobs, time, margin, spacings))
        rows += _compared(blobs, time, steps, lattice, panels if alpha == drawn else Panels())
        rows += _in_time(blobs, times, step, panels)
        rows += [_acted_on(name, *acted, alpha, step) for name, acted in _acts(blobs).items()]
        if alpha == drawn:
            scheme = _errors(blobs, time, _scheme(blobs, time, margin, scheme_spacings))
            panels.add("count", "lattice, exact symbol", *lattice)
            panels.add("count", "lattice, KPSE IV", *scheme)
            _spacings(blobs, [0.0, times[-1]], step, panels)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _acts(blobs: Blobs) -> dict[str, tuple[Exact, dict[str, Any]]]:
    """What acts on particles beside a constant diffusion, with an exact solution.

    The last is a diffusivity D = 1 + 1 / (2 (1 + x^2)), by the exchange, and a source that lets 1 / (1 + x^2) stay.
    """
    varying = {
        "window": (-10.0, 10.0),
        "diffusivity": lambda x: 1.0 + 0.5 * Cauchy.value([x]),
        "source": lambda x, t, u: -exchange_limit(x, blobs.alpha, 0.5),
    }
    drawn = {"window": blobs.window, "velocity": lambda x, t: -x}
    return {
        "velocity -x": (blobs.drawn_together, drawn),
        "source f(x, t, u)": (
            blobs.competing,
            {"window": blobs.window, "source": blobs.competition},
        ),
        "diffusivity D(x)": (lambda x, t: Cauchy.value([x]), varying),
    }


def _acted_on(
    name: str, exact: Exact, acts: dict[str, Any], alpha: float, step: float
) -> dict[str, Any]:
    """The error at t = 1."""
    (state,) = follow(lambda x: exact(x, 0.0), 1.0, alpha=alpha, step=step, **acts)
    size = float(state.particles.volumes @ np.abs(exact(state.particles.x, 1.0)))
    return {
        **_row(alpha, f"{step:g}, {name}", state, _error(exact, state) / size),
        "placements": state.placements,
        "acts": name,
    }


def _row(alpha: float, step: float | str, state: Followed, error: float) -> dict[str, Any]:
    row = {"alpha": alpha, "step": step, "time": state.time, "particles": state.u.size}
    return {**row, "error": three_digits(error)}


def _followed(blobs: Blobs, times: list[float], step: float) -> list[Followed]:
    start: dict[str, Any] = {"alpha": blobs.alpha, "window": blobs.window}
    return follow(lambda x: blobs(x, 0.0), times, step=step, **start)


def _error(exact: Exact, state: Followed) -> float:
    """Sum V |u - exact|; the mass of the blobs is one."""
    off = np.abs(state.u - exact(state.particles.x, state.time))
    return float(state.particles.volumes @ off)


def _compared(
    blobs: Blobs,
    time: float,
    steps: list[float],
    lattice: tuple[np.ndarray, np.ndarray],
    panels: Panels,
) -> Iterator[dict[str, Any]]:
    with quiet():  # the longest steps, whose errors are shown
        states = [_followed(blobs, [time], step)[0] for step in steps]
    counts, errors = [state.u.size for state in states], [_error(blobs, s) for s in states]
    panels.add("count", "adaptive particles", counts, errors)
    n, e = lattice[0], np.minimum.accumulate(lattice[1])
    for step, state, error in zip(steps, states, errors, strict=True):
        known = e[-1] < error <= e[0]
        wanted = float(np.exp(np.interp(np.log(error), np.log(e[::-1]), np.log(n[::-1]))))
        yield {
            **_row(blobs.alpha, step, state, error),
            "of a lattice": round(wanted) if known else np.nan,
            "times fewer": wanted / state.u.size if known else np.nan,
        }


def _in_time(
    blobs: Blobs, times: list[float], step: float, panels: Panels
) -> Iterator[dict[str, Any]]:
    first, *states = _followed(blobs, [0.0, *times], step)
    errors = [_error(blobs, state) for state in states]
    name = f"α = {blobs.alpha:g}"
    panels.add("time", name, times, errors)
    panels.add("particles", name, times, [state.u.size for state in states])
    for state, error in zip(states, errors, strict=True):
        yield {
            **_row(blobs.alpha, f"{step:g}, in time", state, error),
            "placements": state.placements,
            "mass": three_digits(state.mass / first.mass - 1.0),
            "corrected": three_digits(state.corrected),
        }


def _errors(blobs: Blobs, time: float, solved: Solved) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of particles and errors of lattices, from their spacings, points and solutions."""
    with quiet():  # coarse ones are to be seen
        found = [(x.size, h * np.abs(u - blobs(x, time)).sum()) for h, x, u in solved]
    counts, errors = np.array(found).T
    return counts.astype(int), errors


def _lattice(blobs: Blobs, time: float, margin: float, spacings: list[float]) -> Solved:
    """The lattice with the exact symbol and its exterior: nothing on a lattice is better."""
    for h in spacings:
        n = round(margin / h)
        x = 0.5 * blobs.distance + h * np.arange(-n, n)
        yield h, x, evolve(blobs(x, 0.0), h, alpha=blobs.alpha, time=time)


def _scheme(blobs: Blobs, time: float, margin: float, spacings: list[float]) -> Solved:
    """The paper's KPSE of order IV, exact in time."""
    middle = 0.5 * blobs.distance
    for h in spacings:
        case = Case(
            scheme="KPSE", order=4, alpha=blobs.alpha, half_width=margin, spacing=h,
            integrator="exponential", exterior="open", t_initial=0.0, t_final=time,
        )  # fmt: skip
        run = solve(case, initial=lambda x: blobs(x + middle, 0.0))
        yield h, run["x"].values + middle, run["u"].values


def _spacings(blobs: Blobs, times: list[float], step: float, panels: Panels) -> None:
    for state in _followed(blobs, times, step):
        x, volumes = state.particles.x, state.particles.volumes
        seen = (x > blobs.window[0]) & (x < blobs.window[1])
        panels.add("spacing", f"t = {state.time:g}", x[seen], volumes[seen])
