"""The denominator of (7): whether it stays positive, and away from zero (M-C5)."""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from fracparticles.markers import MarkerVelocity, run, shape_function
from fracparticles.moving.lagrangian import FieldNotPositive
from fracstudy.findings import Finding, measured
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import SquareRuns, Trace, load

Traces = Mapping[float, list[Trace]]  # of S8 from random positions, by time step


def traces(square: SquareRuns, small_dt: float, seeds: range) -> Traces:
    """Return the runs that may stop, with the paper's time step and a smaller one."""
    steps = (square.dt, small_dt)
    return {
        dt: [square.having(dt=dt).trace("S8", "random", seed, follow=False) for seed in seeds]
        for dt in steps
    }


def findings(square: SquareRuns, stops: Traces, seed: int) -> Iterator[Finding]:
    """The least denominator over its first term, at the paper's time step and at a smaller one."""
    cases = {"S4": ("S4", "random"), "S7": ("S7", "random"), "S8, midpoints": ("S8", "midpoints")}
    least = {}
    for dt, of_step in stops.items():
        least[dt] = {case: _least(square, dt, *of, seed) for case, of in cases.items()}
        least[dt]["S8, random positions"] = min(
            _least(square, dt, "S8", "random", t.seed) if t.run else 0.0 for t in of_step
        )
    (dt, ours), (small_dt, fine) = stops.items()
    stopped = [trace.stopped.split(": a velocity")[0] for trace in fine if not trace.run]
    yield measured(
        "M-C5.denominator",
        least=least[small_dt],
        stopped=[sum(not trace.run for trace in part) for part in (ours, fine)],
        number=len(fine),
        steps=[dt, small_dt],
        example=stopped[0] if stopped else "none",
        depth=float(-shape_function("S8")(math.sqrt(2.5)) / shape_function("S8")(0.0)),
        others={f"the time step of the paper, {dt:g}": {"least": least[dt]}},
    )
    # W_j at x_j and zero elsewhere, as a Kronecker delta gives it, has the integral zero as the grid is refined.
    x, w = load("midpoints", square.markers)
    kernel = MarkerVelocity(shape_function("S4"), 0.1, derivatives=0)
    z = np.linspace(-1.2, 1.2, 48001)
    fields = np.bincount(np.searchsorted(z, x), w, z.size), kernel.fields(x, w, z)[0]
    kronecker, dirac = (abs((z[1] - z[0]) * f.sum() / w.sum() - 1.0) for f in fields)
    yield measured("M-C5.delta", kronecker=kronecker, dirac=dirac)


def _least(square: SquareRuns, dt: float, name: str, loading: str, seed: int) -> float:
    """The least of sum_k W_k S_eps(x_j - x_k) over W_j S_eps(0); zero if it vanishes or turns negative."""
    velocity = MarkerVelocity(shape_function(name), square.support)
    first = float(velocity.shape(0.0)) / square.support
    x, weights = load(loading, square.markers, seed)
    ratios: list[float] = []

    def observe(t: float, x: np.ndarray, w: np.ndarray) -> None:
        ratios.append(float((velocity.fields(x, w)[0] / (w * first)).min()))

    try:
        run(x, weights, velocity, dt=dt, steps=round(square.t_final / dt), observe=observe)
    except FieldNotPositive:
        return 0.0
    return max(0.0, min(ratios))


def draw_last_field(panels: Panels, stops: Traces, epsilon: float) -> None:
    """F of the first run that stopped, on a grid and at the markers, half a step after the last that it could take."""
    failed = [(dt, trace) for dt, of_step in stops.items() for trace in of_step if not trace.run]
    for dt, trace in failed[:1]:
        velocity = MarkerVelocity(shape_function(trace.shape), epsilon)
        (t, x), weights = trace.last, trace.weights
        if (velocity.fields(x, weights)[0] > 0.0).all():
            x = x + 0.5 * dt * velocity(x, weights)
        half = 1.15 * float(np.abs(x).max())
        z = np.linspace(-half, half, 801)
        panels.add("denominator", "F", z, velocity.fields(x, weights, z)[0], t=t)
        panels.add("denominator", "markers", x, velocity.fields(x, weights)[0], t=t)
