"""Peers for two blobs whose widths are far apart: Fourier on a circle that loses points as they widen, and elements.

A source is split from the diffusion by Strang, and n = 1, 2, .. of these steps are extrapolated in n^(-2), as the
particles of `adaptive.splitting` do:

    half of the source (classical Runge-Kutta), exp(-t (-Laplacian)^(alpha/2)), half of the source.

Fourier: the exponential is exact for each wave. When the narrow blob has doubled its width every other point goes, as
long as there are enough for a width of one. With a velocity the steps are Lawson's, as short as its waves are fast.

Linear elements on a mesh given once, zero beyond it: the exponential is by the eigenvectors of stiffness and mass.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.linalg import eigh

from scenes.run_times.problem_times.interval_peers import stiffness
from scenes.run_times.problem_times.waves import lawson, mended

# A time, the points then, u, and what the points stand for.
State = tuple[float, np.ndarray, np.ndarray, np.ndarray | float]
Answer = tuple[int, list[State]]
Source = Callable[[np.ndarray, float, np.ndarray], np.ndarray]
Rate = Callable[[float, np.ndarray], np.ndarray]
Flow = Callable[[np.ndarray, float], np.ndarray]
Advance = Callable[[np.ndarray, float, float], np.ndarray]

_MOST_STEPS = 6
_PARTS = 2  # of the Runge-Kutta scheme in each half of a step


@dataclass(frozen=True)
class Circle:
    """A circle, the width of the narrow blob at the start, and how many `points` go into a width."""

    alpha: float
    middle: float
    half_width: float
    narrow: float
    points: float

    def halvings(self) -> list[tuple[int, float]]:
        """Numbers of points, each with the time until which it serves, when the narrow blob is twice as wide again."""
        width = self.narrow
        found: list[tuple[int, float]] = []
        while True:
            count = 2 * next_fast_len(round(self.half_width * self.points / width), real=True)
            if 2.0 * width > 1.0:
                return [*found, (count, np.inf)]
            width *= 2.0
            found.append((count, width**self.alpha - self.narrow**self.alpha))


def on_circle(
    circle: Circle,
    initial: Callable[[np.ndarray], np.ndarray],
    times: list[float],
    tolerance: float,
    velocity: Callable[[np.ndarray], np.ndarray] | None = None,
    source: Source | None = None,
) -> Answer:
    """Return the greatest number of points, and the states at these times, in ascending order."""
    halvings = circle.halvings()
    ends = sorted({*times, *(until for _, until in halvings if until < times[-1])})
    t, most = 0.0, halvings[0][0]
    states: list[State] = []
    u, waves = np.zeros(0), np.zeros(0)
    for end in ends:
        count = next(count for count, until in halvings if end <= until)
        h = 2.0 * circle.half_width / count
        x = circle.middle + h * (np.arange(count) - count // 2)
        k = np.pi / circle.half_width * np.arange(count // 2 + 1.0)
        if t == 0.0:
            u = initial(x)
        elif count != u.size:  # fewer points of the same circle
            u = np.asarray(irfft(waves[: count // 2 + 1], count) * (count / u.size))

        def diffused(u: np.ndarray, dt: float, decay: np.ndarray = k**circle.alpha) -> np.ndarray:
            return np.asarray(irfft(np.exp(-dt * decay) * rfft(u), u.size))

        if velocity is not None:
            u = _carried(x, k, circle, velocity, u, end - t, tolerance)
        elif source is not None:
            u = _extrapolated(diffused, partial(source, x), tolerance)(u, t, end)
        else:
            u = diffused(u, end - t)
        t, waves = end, rfft(u)
        if end in times:
            states.append((end, x, u, h))
    return most, states


def _carried(
    x: np.ndarray,
    k: np.ndarray,
    circle: Circle,
    velocity: Callable[[np.ndarray], np.ndarray],
    u: np.ndarray,
    time: float,
    share: float,
) -> np.ndarray:
    """Lawson's scheme in steps of at most a share of the time, and as the velocity allows."""
    a = mended(velocity(x), np.abs(x - circle.middle) / circle.half_width)
    slope = -1j * k
    slope[-1] = 0.0  # the wave of two points has no slope at them
    fastest = float(np.abs(a).max() * k[-1])

    def rate(waves: np.ndarray) -> np.ndarray:
        return np.asarray(slope * rfft(a * irfft(waves, x.size)))

    least = int(np.ceil(1.0 / share))
    waves = lawson(rate, k**circle.alpha, rfft(u), time, fastest, least)
    return np.asarray(irfft(waves, x.size))


def on_elements(
    alpha: float,
    initial: Callable[[np.ndarray], np.ndarray],
    nodes: np.ndarray,
    times: list[float],
    tolerance: float,
    source: Source,
) -> Answer:
    """Return the number of inner nodes, and the states at these times, in ascending order, between which it steps."""
    x, h = nodes[1:-1], np.diff(nodes)
    mass = np.diag((h[1:] + h[:-1]) / 3.0) + np.diag(h[1:-1] / 6.0, 1) + np.diag(h[1:-1] / 6.0, -1)
    rates, modes = eigh(stiffness(np.abs(nodes[:, None] - nodes), alpha), mass)
    back = modes.T @ mass

    def diffused(u: np.ndarray, dt: float) -> np.ndarray:
        return np.asarray(modes @ (np.exp(-dt * rates) * (back @ u)))

    u, advance = initial(x), _extrapolated(diffused, partial(source, x), tolerance)
    states: list[State] = []
    for start, end in pairwise([0.0, *times]):
        u = advance(u, start, end)
        states.append((end, x, u, 0.5 * (h[1:] + h[:-1])))
    return x.size, states


def _extrapolated(diffused: Flow, source: Rate, tolerance: float) -> Advance:
    """Return the way from one time to another, to within a share of sum |u|."""

    def steps(u: np.ndarray, start: float, end: float, count: int) -> np.ndarray:
        dt = (end - start) / count
        for n in range(count):
            t = start + n * dt
            u = _runge_kutta(source, u, t, t + 0.5 * dt)
            u = _runge_kutta(source, diffused(u, dt), t + 0.5 * dt, t + dt)
        return u

    def advance(u: np.ndarray, start: float, end: float) -> np.ndarray:
        row: list[np.ndarray] = []
        for n in range(1, _MOST_STEPS + 1):
            above, row = row, [steps(u, start, end, n)]
            for k, last in enumerate(above, start=1):
                row.append(row[-1] + (row[-1] - last) / ((n / (n - k)) ** 2 - 1.0))
            size = tolerance * np.abs(row[-1]).sum()
            if n > 2 and np.abs(row[-1] - row[-2]).sum() <= size < np.inf:
                return row[-1]
        # The time is halved where six steps do not do.
        middle = 0.5 * (start + end)
        return advance(advance(u, start, middle), middle, end)

    return advance


def _runge_kutta(rate: Rate, u: np.ndarray, start: float, end: float) -> np.ndarray:
    dt = (end - start) / _PARTS
    for n in range(_PARTS):
        t = start + n * dt
        first = rate(t, u)
        second = rate(t + 0.5 * dt, u + 0.5 * dt * first)
        third = rate(t + 0.5 * dt, u + 0.5 * dt * second)
        fourth = rate(t + dt, u + dt * third)
        u = u + dt / 6.0 * (first + 2.0 * (second + third) + fourth)
    return u
