"""Adaptive particles against lattices: two blobs, of widths a hundred times apart, far from one another."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.adaptive.follow import Followed, follow
from fracparticles.errors import AccuracyWarning
from fracparticles.run.case import Case
from fracparticles.run.solve import solve
from fracparticles.special import green
from fracparticles.time.whole_space import evolve
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.problems.adaptive_particles.acts import ACTS, Exact

__all__ = ["study"]

_ROUNDING = 1e-13  # errors below are written as that
_EXACT = "lattice, exact symbol"
_SCHEME = "lattice, KPSE IV"


@dataclass(frozen=True)
class _Blobs:
    """Two fundamental solutions of mass 1/2; an exact solution."""

    alpha: float
    widths: list[float]
    distance: float

    def __call__(self, x: np.ndarray, t: float) -> np.ndarray:
        narrow, wide = (width**self.alpha + t for width in self.widths)
        at = x - self.distance
        return np.asarray(0.5 * green(x, narrow, self.alpha) + 0.5 * green(at, wide, self.alpha))

    def followed(self, times: list[float], step: float) -> list[Followed]:
        """The particles at these times."""
        window = -0.4 * self.distance, 1.6 * self.distance
        return follow(lambda x: self(x, 0.0), times, alpha=self.alpha, window=window, step=step)

    def error(self, state: Followed) -> float:
        """Sum V |u - exact|; the mass is one."""
        exact = self(state.particles.x, state.time)
        return float(state.particles.volumes @ np.abs(state.u - exact))


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
        blobs = _Blobs(alpha, widths, distance)
        lattice = _lattice(blobs, times[0], margin, spacings)
        rows += _compared(blobs, times[0], steps, lattice, panels if alpha == drawn else Panels())
        rows += _in_time(blobs, times, step, panels)
        rows += [_acted_on(name, act, alpha, step) for name, act in ACTS.items()]
        if alpha == drawn:
            panels.add("count", _EXACT, *lattice)
            panels.add("count", _SCHEME, *_scheme(blobs, times[0], margin, scheme_spacings))
            _spacings(blobs, [0.0, times[-1]], step, panels)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _acted_on(
    name: str, act: Callable[[float], tuple[Exact, dict[str, Any]]], alpha: float, step: float
) -> dict[str, Any]:
    """The error at t = 1 of what an exact solution is known of."""
    exact, acts = act(alpha)
    (state,) = follow(lambda x: exact(x, 0.0), 1.0, alpha=alpha, step=step, **acts)
    x, volumes = state.particles.x, state.particles.volumes
    size = float(volumes @ np.abs(exact(x, 1.0)))
    return {
        "alpha": alpha,
        "step": f"{step:g}, {name}",
        "time": 1.0,
        "particles": x.size,
        "error": _short(float(volumes @ np.abs(state.u - exact(x, 1.0))) / size),
        "placements": state.placements,
        "acts": name,
    }


def _compared(
    blobs: _Blobs,
    time: float,
    steps: list[float],
    lattice: tuple[np.ndarray, np.ndarray],
    panels: Panels,
) -> Iterator[dict[str, Any]]:
    counts, errors = [], []
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", AccuracyWarning
        )  # the longest steps, whose errors are shown
        for step in steps:
            (state,) = blobs.followed([time], step)
            counts.append(state.u.size)
            errors.append(blobs.error(state))
    panels.add("count", "adaptive particles", counts, errors)
    for step, count, error in zip(steps, counts, errors, strict=True):
        n, e = lattice[0], np.minimum.accumulate(lattice[1])
        known = e[-1] < error <= e[0]
        wanted = float(np.exp(np.interp(np.log(error), np.log(e[::-1]), np.log(n[::-1]))))
        yield {
            "alpha": blobs.alpha,
            "step": step,
            "time": time,
            "particles": count,
            "error": _short(error),
            "of a lattice": round(wanted) if known else np.nan,
            "times fewer": wanted / count if known else np.nan,
        }


def _in_time(
    blobs: _Blobs, times: list[float], step: float, panels: Panels
) -> Iterator[dict[str, Any]]:
    first, *states = blobs.followed([0.0, *times], step)
    errors = [blobs.error(state) for state in states]
    name = f"α = {blobs.alpha:g}"
    panels.add("time", name, times, errors)
    panels.add("particles", name, times, [state.u.size for state in states])
    for state, error in zip(states, errors, strict=True):
        yield {
            "alpha": blobs.alpha,
            "step": f"{step:g}, in time",
            "time": state.time,
            "particles": state.u.size,
            "error": _short(error),
            "placements": state.placements,
            "mass": _short(state.mass / first.mass - 1.0),
            "corrected": _short(state.corrected),
        }


def _lattice(
    blobs: _Blobs, time: float, margin: float, spacings: list[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Particles and errors of the lattice with the exact symbol and its exterior: nothing on a lattice is better."""
    counts, errors = [], []
    for h in spacings:
        n = round(margin / h)
        x = 0.5 * blobs.distance + h * np.arange(-n, n)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # coarse ones are to be seen
            u = evolve(blobs(x, 0.0), h, alpha=blobs.alpha, time=time)
        counts.append(2 * n)
        errors.append(h * np.abs(u - blobs(x, time)).sum())
    return np.array(counts), np.array(errors)


def _scheme(
    blobs: _Blobs, time: float, margin: float, spacings: list[float]
) -> tuple[list[int], list[float]]:
    """The same of the paper's KPSE of order IV, exact in time."""
    counts, errors, middle = [], [], 0.5 * blobs.distance
    for h in spacings:
        case = Case(
            scheme="KPSE", order=4, alpha=blobs.alpha, half_width=margin, spacing=h,
            integrator="exponential", exterior="open", t_initial=0.0, t_final=time,
        )  # fmt: skip
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)
            run = solve(case, initial=lambda x: blobs(x + middle, 0.0))
        x = run["x"].values
        counts.append(x.size)
        errors.append(h * np.abs(run["u"].values - blobs(x + middle, time)).sum())
    return counts, errors


def _spacings(blobs: _Blobs, times: list[float], step: float, panels: Panels) -> None:
    for state in blobs.followed(times, step):
        x, volumes = state.particles.x, state.particles.volumes
        seen = (x > -0.4 * blobs.distance) & (x < 1.6 * blobs.distance)
        panels.add("spacing", f"t = {state.time:g}", x[seen], volumes[seen])


def _short(error: float) -> float:
    return float(f"{max(abs(error), _ROUNDING):.3g}")
