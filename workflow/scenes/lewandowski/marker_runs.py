"""What the marker studies share: the readings of the initial loading, a run with its error norm, clusters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from fracparticles.markers import (
    MarkerRun,
    MarkerVelocity,
    Square,
    equal_weight,
    random,
    run,
    shape_function,
    uniform,
)
from fracparticles.moving.lagrangian import FieldNotPositive

__all__ = [
    "LOADINGS",
    "Trace",
    "cluster_centres",
    "delay",
    "emptiness",
    "fixed_grid",
    "load",
    "spectrum",
    "trace",
    "traces",
]

SQUARE = Square()
# What the text leaves open: where the N markers of the square profile (12) start.
LOADINGS = {
    "midpoints": "midpoints of [-1, 1]",
    "random": "random in [-1, 1]",
    "wide": "uniform in [-L, L]",
}
_FEWEST = 3  # markers that make a cluster


@dataclass(frozen=True)
class Trace:
    """A run with its error norm.

    Attributes
    ----------
    shape, loading : str
    seed : int
    dt : float
    x0, weights : array, shape (N,)
        The markers at the start.
    t, error : array
        Times, and E(t) then: all, or the last only.
    run : MarkerRun or None
        The end of the run; None if it stopped.
    stopped : str
        Why, when and where it stopped; empty if it did not.
    """

    shape: str
    loading: str
    seed: int
    dt: float
    x0: np.ndarray
    weights: np.ndarray
    t: np.ndarray
    error: np.ndarray
    run: MarkerRun | None
    stopped: str

    @property
    def end(self) -> MarkerRun:
        """The end of a run that did not stop."""
        if self.run is None:
            raise FieldNotPositive(f"{self.shape}, {LOADINGS[self.loading]}: {self.stopped}")
        return self.run

    @property
    def turn(self) -> int:
        """The index of the least E."""
        return int(np.argmin(self.error))

    @property
    def turned(self) -> bool:
        """Whether E falls at first, and has risen by a tenth at least from its least value to the end."""
        return bool(self.turn > 0 and self.error[-1] > 1.1 * self.error[self.turn])

    @property
    def linearity(self) -> float:
        """The correlation of E with t from its least value on; nan if that is less than five steps."""
        t, error = self.t[self.turn :], self.error[self.turn :]
        return float(np.corrcoef(t, error)[0, 1]) if t.size > 5 else float("nan")


def fixed_grid(parameters: Mapping[str, Any]) -> np.ndarray:
    """X_g = -L + (g - 1) 2 L / (N_g - 1)."""
    half = float(parameters["half_width"])
    return np.linspace(-half, half, int(parameters["grid"]))


def load(
    loading: str, count: int, seed: int = 0, half_width: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and weights of the square profile in one of `LOADINGS`, those of no weight left out."""
    if loading == "midpoints":
        return equal_weight(SQUARE, count)
    if loading == "random":
        return random(SQUARE, count, np.random.default_rng(seed))
    x, weights = uniform(SQUARE.value, (-half_width, half_width), count)
    return x[weights > 0.0], weights[weights > 0.0]


def trace(
    parameters: Mapping[str, Any],
    shape: str,
    loading: str,
    seed: int = 0,
    *,
    follow: bool = True,
    printed: bool = False,
    **changes: Any,
) -> Trace:
    """Run the square profile and measure E(t) on the fixed grid, at every time or (`follow` false) at the end.

    Parameters of the scene, or `changes`: `support`, `dt`, `t_final`, `markers`, `half_width`, `grid`. With `printed`
    the shape function has its printed constant.
    """
    p = {**parameters, **changes}
    grid, dt = fixed_grid(p), float(p["dt"])
    x0, weights = load(loading, int(p["markers"]), seed, float(p["half_width"]))
    s = shape_function(shape).as_printed() if printed else shape_function(shape)
    velocity = MarkerVelocity(s, float(p["support"]))
    field = MarkerVelocity(s, float(p["support"]), derivatives=0)
    step, steps = grid[1] - grid[0], round(float(p["t_final"]) / dt)
    last = (steps - 0.5) * dt
    times: list[float] = []
    errors: list[float] = []

    def observe(t: float, x: np.ndarray, w: np.ndarray) -> None:
        if not follow and t < last:
            return
        gap = SQUARE.value(grid, t) - field.fields(x, w, grid)[0]
        times.append(t)
        errors.append(float(np.sqrt(step * np.sum(gap * gap))))

    end, stopped = None, ""
    try:
        end = run(x0, weights, velocity, dt=dt, steps=steps, observe=observe)
    except FieldNotPositive as error:
        stopped = str(error)
    return Trace(
        shape, loading, seed, dt, x0, weights, np.array(times), np.array(errors), end, stopped
    )


def traces(
    parameters: Mapping[str, Any], shapes: list[str], seeds: int = 1, follow: bool = True
) -> list[Trace]:
    """Return a run for every shape function and loading, with that many seeds of the random one."""
    first = int(parameters["seed"])
    return [
        trace(parameters, shape, loading, first + n, follow=follow)
        for shape in shapes
        for loading in LOADINGS
        for n in range(seeds if loading == "random" else 1)
    ]


def delay(grid: np.ndarray, f: np.ndarray, t: float) -> tuple[float, float]:
    """Return the tau with which the exact f(x, t - tau) is nearest to F, and the part of the error that is left."""

    def distance(tau: float) -> float:
        return float(np.linalg.norm(f - SQUARE.value(grid, t - tau)))

    found = minimize_scalar(distance, bounds=(-0.5 * t, 0.9 * t), method="bounded")
    return float(found.x), float(found.fun / distance(0.0))


def cluster_centres(x: np.ndarray, gap: float, within: float) -> np.ndarray:
    """Return the centres of the groups of three markers or more with gaps above `gap` between them."""
    x = np.sort(x)
    groups = np.split(x, np.flatnonzero(np.diff(x) > gap) + 1)
    centres = np.array([g.mean() for g in groups if g.size >= _FEWEST])
    return centres[np.abs(centres) < within]


def spectrum(x: np.ndarray, k: np.ndarray, within: float) -> np.ndarray:
    """Return |sum_j w_j exp(i k x_j)|^2 / sum_j w_j^2 with w = cos^2(pi x / (2 within)) for |x| < within.

    Independent markers give about 1, equally spaced ones about 0, clusters a peak at 2 pi / their distance.
    """
    x = x[np.abs(x) < within]
    w = np.cos(0.5 * np.pi * x / within) ** 2
    return np.abs(np.exp(1j * np.multiply.outer(k, x)) @ w) ** 2 / np.sum(w * w)


def emptiness(x: np.ndarray, gap: float, within: float) -> float:
    """Return the part of |x| < within that lies in gaps wider than `gap`: near 1 for clusters, near 0 without."""
    inside = np.sort(x[np.abs(x) < within])
    gaps = np.diff(np.concatenate([[-within], inside, [within]]))
    return float(gaps[gaps > gap].sum() / (2.0 * within))
