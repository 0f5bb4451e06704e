"""Runs of the square profile (12), and what is measured of their markers.

The text leaves open where the markers start. Each of `LOADINGS` is run, the random one with several seeds.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
import pandas as pd
from numpy.polynomial import Polynomial
from pydantic import BaseModel, ConfigDict
from scipy.optimize import minimize_scalar

from fracparticles.markers import MarkerVelocity, equal_weight, random, run, shape_function, uniform
from fracparticles.markers.clusters import emptiness
from fracparticles.markers.profiles import Square
from fracparticles.markers.shapes import Shape
from fracparticles.markers.solver import MarkerRun
from fracparticles.moving.lagrangian import FieldNotPositive
from fracstudy.findings import Finding, measured

SQUARE = Square()
LOADINGS = {
    "midpoints": "midpoints of [-1, 1]",
    "random": "random in [-1, 1]",
    "wide": "uniform in [-L, L]",
}
SHAPES = ("S4", "S7", "S8")  # of Figs. 8-16
# In units of eps: gaps between markers that count, and where they are looked for.
_GAP, _WITHIN = 0.2, 3.0
_CLUSTERED = 0.1  # of |x| < within empty: independent markers give a hundredth, clusters nearly all


class _Infinite(Shape):
    """(1 + 2 x^2) exp(-x^2) / (2 sqrt(pi)), of infinite support, with (1 - k^2/4) exp(-k^2/4), negative for k > 2."""

    @property
    def moment_order(self) -> int:
        """The second moment is 1."""
        return 2

    def transform(self, k: Any) -> np.ndarray:
        """Return int S(x) exp(-i k x) dx."""
        q = 0.25 * np.square(k)
        return (1.0 - q) * np.exp(-q)


_HALF = 0.5 / math.sqrt(math.pi)
INFINITE = _Infinite(
    "S9", "not in the paper", "", _HALF, _HALF, Polynomial([1.0, 0.0, 2.0]), gaussian=True, finite=False
)  # fmt: skip
"""A smooth shape function of infinite support, like S8, but with a transform that turns negative."""


def shape(name: str) -> Shape:
    """Return the shape function of that name: S1 to S8 of the paper, or S9, `INFINITE`."""
    return INFINITE if name == INFINITE.name else shape_function(name)


@dataclass(frozen=True)
class Trace:
    """A run with its error norm E(t), at all times or at the last only."""

    shape: str
    loading: str
    seed: int
    x0: np.ndarray  # the markers at the start
    weights: np.ndarray
    t: np.ndarray
    error: np.ndarray
    last: tuple[float, np.ndarray]  # the last time that the run reached, and the markers then
    run: MarkerRun | None  # none if it stopped
    stopped: str  # why, when and where; empty if it did not

    @property
    def end(self) -> MarkerRun:
        """The end of a run that did not stop."""
        if self.run is None:
            raise FieldNotPositive(f"{self.shape}, {LOADINGS[self.loading]}: {self.stopped}")
        return self.run


class SquareRuns(BaseModel):
    """What the runs of a scene share."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    support: float = 1.0  # eps
    dt: float
    t_final: float
    markers: int  # N, of which the start "wide" leaves out those of no weight
    half_width: float  # L
    grid: int  # N_g

    @cached_property
    def z(self) -> np.ndarray:
        """The fixed grid X_g = -L + (g - 1) 2 L / (N_g - 1)."""
        return np.linspace(-self.half_width, self.half_width, self.grid)

    @cached_property
    def exact(self) -> np.ndarray:
        """f on the fixed grid at the end."""
        return self.f(self.z)

    def f(self, x: np.ndarray) -> np.ndarray:
        """Return the exact solution at the end."""
        return SQUARE.value(x, self.t_final)

    def having(self, **changes: Any) -> Self:
        """Return other runs, with some values changed."""
        return type(self)(**{**self.model_dump(), **changes})

    def relative_error(self, f: np.ndarray) -> float:
        """Return the distance of f from the exact solution on the fixed grid, as part of its norm."""
        return float(np.linalg.norm(f - self.exact) / np.linalg.norm(self.exact))

    def peak(self, f: np.ndarray) -> float:
        """Return f(0), as part of that of the exact solution."""
        return float(np.interp(0.0, self.z, f) / np.interp(0.0, self.z, self.exact))

    def trace(
        self, name: str, loading: str, seed: int = 0, *, follow: bool = True, printed: bool = False
    ) -> Trace:
        """Run and measure E(t) on the fixed grid, at every time or (`follow` false) at the end.

        With `printed` the shape function has its printed constant.
        """
        x0, weights = load(loading, self.markers, seed, self.half_width)
        s = shape(name).as_printed() if printed else shape(name)
        velocity = MarkerVelocity(s, self.support)
        field = MarkerVelocity(s, self.support, derivatives=0)
        steps = round(self.t_final / self.dt)
        times: list[float] = []
        errors: list[float] = []
        latest = (0.0, x0)

        def observe(t: float, x: np.ndarray, w: np.ndarray) -> None:
            nonlocal latest
            latest = (t, x)
            if follow or t > (steps - 0.5) * self.dt:
                gap = SQUARE.value(self.z, t) - field.fields(x, w, self.z)[0]
                times.append(t)
                errors.append(float(np.sqrt((self.z[1] - self.z[0]) * np.sum(gap * gap))))

        end, stopped = None, ""
        try:
            end = run(x0, weights, velocity, dt=self.dt, steps=steps, observe=observe)
        except FieldNotPositive as error:
            stopped = str(error)
        followed = (np.array(times), np.array(errors))
        return Trace(name, loading, seed, x0, weights, *followed, latest, end, stopped)


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


def delay(z: np.ndarray, f: np.ndarray, t: float) -> tuple[float, float]:
    """Return the tau with which the exact f(z, t - tau) is nearest to F, and the part of the error that is left."""

    def distance(tau: float) -> float:
        return float(np.linalg.norm(f - SQUARE.value(z, t - tau)))

    found = minimize_scalar(distance, bounds=(-0.5 * t, 0.9 * t), method="bounded")
    return float(found.x), float(found.fun / distance(0.0))


class Starts:
    """The runs with some shape functions from all starts: those that stopped, and what is `measured` of the others.

    Markers form clusters if over a tenth of |x| < 3 eps lies in gaps wider than eps / 5.
    """

    def __init__(
        self, runs: SquareRuns, shapes: Iterable[str], seeds: range, follow: bool = False
    ) -> None:
        self.gap, self.within = _GAP * runs.support, _WITHIN * runs.support
        traces = [
            runs.trace(shape, loading, seed, follow=follow)
            for shape in shapes
            for loading in LOADINGS
            for seed in (seeds if loading == "random" else seeds[:1])
        ]
        self.runs = [trace for trace in traces if trace.run]
        self.stopped = [trace for trace in traces if not trace.run]
        self.measured = pd.DataFrame([self._row(runs, trace) for trace in self.runs])
        self.clustered = self.measured["empty"] > _CLUSTERED

    def _row(self, runs: SquareRuns, trace: Trace) -> dict[str, Any]:
        f = trace.end.field(runs.z)
        inner = f[np.abs(runs.z) < self.within]
        return {
            "S": trace.shape,
            "loading": trace.loading,
            "seed": trace.seed,
            "relative error": runs.relative_error(f),
            "F(0) / f(0)": runs.peak(f),
            "maxima": int(np.sum((inner[1:-1] > inner[:-2]) & (inner[1:-1] >= inner[2:]))),
            "empty": emptiness(trace.end.x, self.gap, self.within),
        }

    def random(self, shape: str) -> pd.Series:
        """Return which runs have this shape function and start at random."""
        return (self.measured["S"] == shape) & (self.measured["loading"] == "random")

    def share(self, shape: str) -> float:
        """Return the part of the random starts that form clusters."""
        return float(self.clustered[self.random(shape)].mean())

    def mean(self, shape: str, column: str = "relative error") -> float:
        """Return the mean over the random starts."""
        return float(self.measured.loc[self.random(shape), column].mean())

    @property
    def first(self) -> list[Trace]:
        """Every shape function and start once, the random one with the first seed that ran to the end."""
        shown: dict[tuple[str, str], Trace] = {}
        for trace in self.runs:
            shown.setdefault((trace.shape, trace.loading), trace)
        return list(shown.values())

    def table(self, columns: list[str], counted: tuple[str, ...] = ()) -> pd.DataFrame:
        """Return one row a shape function and start: medians over the seeds, and how many runs have what is counted."""
        rows = []
        for (shape, loading), part in self.measured.groupby(["S", "loading"], sort=False):
            row = {"S": shape, "loading": LOADINGS[loading], "runs": len(part)}
            row["with clusters"] = int(self.clustered[part.index].sum())
            row |= {column: part[column].median() for column in columns}
            row |= {column: int(part[column].sum()) for column in counted}
            rows.append(row)
        return pd.DataFrame(rows)


def with_other_seeds(
    ours: Mapping[str, Mapping[str, Any]], others: Mapping[str, Mapping[str, Any]]
) -> list[Finding]:
    """Return what was measured for each claim, beside the same numbers of other random starts."""
    return [
        measured(claim, others={"other seeds": others[claim]}, **numbers)
        for claim, numbers in ours.items()
    ]
