"""A contest in the plane: a blob carried round the origin while it spreads, u_t + div(a u) = -(-Laplacian)^(alpha/2) u.

a = (-y, x), from the fundamental solution of t = 1 about (0, 2), for a quarter of a turn: the fundamental solution
about (-2, 0). The error is the greatest for |x|, |y| <= 6, over the greatest value. Peers, both periodic:

- Fourier, products at the points; Lawson's form of the classical Runge-Kutta scheme.
- Fractional centred differences, [(4 sin^2(k_x h/2) + 4 sin^2(k_y h/2)) / h^2]^(alpha/2), and central ones of second
  order for the velocity: the symbol of `Fourier` by another.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.fft import irfft2, rfft2

from fracparticles.special import green
from fracstudy.errors import off
from scenes.run_times.problem_times.contest import Contest, Points, on_lattices
from scenes.run_times.problem_times.waves import lawson, mended

_FROM = 2.0
_TIME = 0.5 * np.pi
_SEEN = 6.0


def carried_round(alpha: float) -> Contest:
    """A quarter of a turn."""

    def blob(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.asarray(green(np.hypot(x, y - _FROM), 1.0, alpha, 2))

    def error(answer: Points) -> float:
        x, u = answer
        near = np.abs(x) <= _SEEN
        at = x[near]
        exact = np.asarray(green(np.hypot(at[:, None] + _FROM, at), 1.0 + _TIME, alpha, 2))
        return off(u[np.ix_(near, near)], exact)

    fields: dict[str, Any] = {"alpha": alpha, "dim": 2, "velocity": ("-y", "x"), "t_final": _TIME}
    symbols = {"Fourier, circle": _waves, "differences": _differences}
    peers = {name: partial(_periodic, alpha, blob, symbol) for name, symbol in symbols.items()}
    return Contest(error, on_lattices(["DD"], blob, **fields), peers)


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
) -> tuple[int, Points]:
    """At least so many steps, and as many as the velocity asks."""
    n = round(half_width / spacing)
    count, h = 2 * n, half_width / n
    x = h * np.arange(-n, n)
    k = 2.0 * np.pi * np.fft.fftfreq(count, h)
    slope, second = symbols(k, h)
    real = slice(0, n + 1)
    decay = (second[:, None] + np.abs(second[real])) ** (0.5 * alpha)
    along = -1j * slope[:, None], -1j * slope[real]
    ramp = mended(x, np.abs(x) / half_width)
    fastest = 2.0 * float(ramp.max() * np.abs(slope).max())

    def rate(waves: np.ndarray) -> np.ndarray:
        u = irfft2(waves, (count, count))
        return np.asarray(along[0] * rfft2(-ramp * u) + along[1] * rfft2(ramp[:, None] * u))

    waves = lawson(rate, decay, rfft2(blob(x[:, None], x)), _TIME, fastest, least)
    return x.size**2, (x, irfft2(waves, (count, count)))
