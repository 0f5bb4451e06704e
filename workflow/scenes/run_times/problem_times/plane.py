"""A contest in the plane: a blob carried round the origin while it spreads, u_t + div(a u) = -(-Laplacian)^(alpha/2) u.

a = (-y, x), from the fundamental solution of t = 1 about (0, 2), for a quarter of a turn: the fundamental solution
about (-2, 0). The error is the greatest for |x|, |y| <= 6, over the greatest value. Peers, both periodic:

- Fourier, products at the points; Lawson's form of the classical Runge-Kutta scheme.
- Fractional centred differences, [(4 sin^2(k_x h/2) + 4 sin^2(k_y h/2)) / h^2]^(alpha/2), and central ones of second
  order for the velocity: the symbol of `Fourier` by another.

On the torus the velocity jumps where the ends meet; it is mended beyond four fifths of the half-width.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.fft import irfft2, rfft2

from fracparticles.problems import Problem, solve_problem
from fracparticles.special import green
from scenes.run_times.problem_times.contest import OURS, PEER, Contender, Contest

__all__ = ["carried_round"]

_FROM = 2.0
_TIME = 0.5 * np.pi
_SEEN = 6.0
_MENDED = 0.8
_STABLE = 2.5  # of the Runge-Kutta scheme's 2.8 on the imaginary axis

Answer = tuple[int, tuple[np.ndarray, np.ndarray]]


def carried_round(alpha: float) -> Contest:
    """A quarter of a turn."""

    def blob(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray(green(np.hypot(x, y - _FROM), 1.0, alpha, 2))

    def ours(
        form: str, order: int, half_width: float, spacing: float, rtol: float, overlap: float = 2.0
    ) -> Answer:
        problem = Problem(
            alpha=alpha, dim=2, form=form, order=order, half_width=half_width, spacing=spacing, rtol=rtol,
            overlap=overlap, velocity=("-y", "x"), t_final=_TIME,
        )  # fmt: skip
        run = solve_problem(problem, blob)
        return run["u"].size, (run["x"].values, run["u"].values)

    def error(answer: tuple[np.ndarray, np.ndarray]) -> float:
        x, u = answer
        near = np.abs(x) <= _SEEN
        at = x[near]
        exact = np.asarray(green(np.hypot(at[:, None] + _FROM, at), 1.0 + _TIME, alpha, 2))
        return float(np.abs(u[np.ix_(near, near)] - exact).max() / exact.max())

    return Contest(
        error,
        {
            "DD 4": Contender(OURS, partial(ours, "DD", 4)),
            "DD 12": Contender(OURS, partial(ours, "DD", 12)),
            "Fourier, circle": Contender(PEER, partial(_periodic, alpha, blob, _waves)),
            "differences": Contender(PEER, partial(_periodic, alpha, blob, _differences)),
        },
    )


def _waves(k: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """The symbols of the first derivative over i, and of minus the second."""
    slope = k.copy()
    slope[np.abs(k) * h > np.pi * (1.0 - 1e-9)] = 0.0  # the wave of two points has none at them
    return slope, k * k


def _differences(k: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    return np.sin(k * h) / h, (2.0 / h * np.sin(0.5 * k * h)) ** 2


def _periodic(
    alpha: float,
    blob: Callable[[np.ndarray, np.ndarray], np.ndarray],
    symbols: Callable[[np.ndarray, float], tuple[np.ndarray, np.ndarray]],
    half_width: float,
    spacing: float,
    least: int,
) -> Answer:
    """At least so many steps, and as many as the velocity asks."""
    n = round(half_width / spacing)
    count, h = 2 * n, half_width / n
    x = h * np.arange(-n, n)
    k = 2.0 * np.pi * np.fft.fftfreq(count, h)
    slope, second = symbols(k, h)
    real = slice(0, n + 1)
    decay = (second[:, None] + np.abs(second[real])) ** (0.5 * alpha)
    along = -1j * slope[:, None], -1j * slope[real]
    far = np.clip((np.abs(x) / half_width - _MENDED) / (1.0 - _MENDED), 0.0, 1.0)
    ramp = x * 0.5 * (1.0 + np.cos(np.pi * far))
    fastest = 2.0 * float(ramp.max() * np.abs(slope).max())
    steps = max(least, int(np.ceil(_TIME * fastest / _STABLE)))
    dt = _TIME / steps
    half = np.exp(-0.5 * dt * decay)

    def rate(waves: np.ndarray) -> np.ndarray:
        u = irfft2(waves, (count, count))
        return np.asarray(along[0] * rfft2(-ramp * u) + along[1] * rfft2(ramp[:, None] * u))

    waves = rfft2(blob(x[:, None], x))
    for _ in range(steps):
        first = rate(waves)
        second_ = rate(half * (waves + 0.5 * dt * first))
        third = rate(half * waves + 0.5 * dt * second_)
        fourth = rate(half * (half * waves + dt * third))
        waves = half * (half * (waves + dt / 6.0 * first) + dt / 3.0 * (second_ + third))
        waves += dt / 6.0 * fourth
    return x.size**2, (x, irfft2(waves, (count, count)))
